/// What must hold for any value: written and read back it is the same, and only whole bytes are
/// read.
#include <rapidcheck/gtest.h>

#include <map>

#include "plumb/data/archive.hpp"
#include "plumb/data/file_bytes.hpp"

namespace plumb {
namespace {

using Mixed = std::vector<std::map<std::string, std::vector<std::int32_t>>>;

RC_GTEST_PROP(Archive, GivesBackWhatItTook, (const Mixed& value)) {
  RC_ASSERT(from_bytes<Mixed>(to_bytes(value)) == value);
}

RC_GTEST_PROP(Archive, EqualValuesHaveEqualHashesAndOthersNot, (const Mixed& a, const Mixed& b)) {
  RC_ASSERT((content_hash(a) == content_hash(b)) == (a == b));
}

RC_GTEST_PROP(Archive, RefusesBytesThatAreCutOrHaveMore, (const Mixed& value)) {
  const std::string whole = to_bytes(value);
  RC_ASSERT_THROWS_AS(from_bytes<Mixed>(whole + "x"), Error);
  const auto cut = *rc::gen::inRange<std::size_t>(0, whole.size());
  RC_ASSERT_THROWS_AS(from_bytes<Mixed>(whole.substr(0, cut)), Error);
}

RC_GTEST_PROP(Archive, AnyBytesAreReadOrRefused, (const std::string& bytes)) {
  try {
    const Mixed value = from_bytes<Mixed>(bytes);
    RC_ASSERT(from_bytes<Mixed>(to_bytes(value)) == value);
  } catch (const Error&) {
    RC_SUCCEED("refused");
  }
}

RC_GTEST_PROP(FileBytes, AreWhatWasAppended, (const std::vector<std::string>& pieces)) {
  FileBytes bytes;
  std::string all;
  for (const std::string& piece : pieces) bytes.append(piece), all += piece;
  RC_ASSERT(bytes.text() == all);
  RC_ASSERT(from_bytes<FileBytes>(to_bytes(bytes)).text() == all);
}

}  // namespace
}  // namespace plumb
