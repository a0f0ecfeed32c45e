#include "plumb/plugin/manifest.hpp"

#include <gmock/gmock.h>

#include "plumb/data/error.hpp"

namespace plumb {
namespace {

using testing::HasSubstr;

/// A step of version 7 with a whole parameter whose default is 5.
Manifest small_manifest() {
  StepDescription step;
  step.name = "test.small";
  step.version = 7;
  ParameterDescription count;
  count.name = "count";
  count.kind = ParameterKind::integer;
  count.standard = std::int64_t{5};
  step.parameters = {count};
  return {"abi", {step}};
}

std::string with(const std::string& old, const std::string& fresh) {
  std::string text = manifest_text(small_manifest());
  return text.replace(text.find(old), old.size(), fresh);
}

std::string refusal_of(const std::string& text) {
  try {
    read_manifest(text, "small.json");
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(Manifest, IsReadAsItWasWritten) {
  const std::string text = manifest_text(small_manifest());
  EXPECT_EQ(manifest_text(read_manifest(text, "small.json")), text);
}

TEST(Manifest, TakesNoOtherNumberForAWholeOne) {
  const auto told = HasSubstr("small.json: not a manifest that can be used: a whole number");
  for (const char* version : {"7.5", "1e300", "2147483648", "true"})
    EXPECT_THAT(refusal_of(with("\"version\": 7", std::string("\"version\": ") + version)), told);
  for (const char* standard : {"5.5", "-1e300", "9223372036854775808", "\"5\""})
    EXPECT_THAT(refusal_of(with("\"default\": 5", std::string("\"default\": ") + standard)), told);
  EXPECT_EQ(refusal_of(with("\"default\": 5", "\"default\": -9223372036854775808")), "");
}

}  // namespace
}  // namespace plumb
