#include "plumb/store/blob.hpp"

#include "../fuzz.hpp"

using namespace plumb;

/// What stands in a blob between its key and its checksum, both of which are right: the step, then
/// values of any type.
PLUMB_FUZZ_READER(blob) {
  const Hash128 key{1, 2};
  OutArchive<TextSink> file;
  file.text = "plumb blob 2\n";
  file(key.high, key.low);
  file.put(bytes.data(), bytes.size());
  const Hash128 sum = hash_of(file.text);
  file(sum.high, sum.low);
  const auto result = read_blob(key, file.text);
  if (!result) throw Error("not a blob of this program");
  for (const auto& values : result->outputs)
    for (const AnyValue& value : values) {
      value.type->code->hash(value.value.get());
      value.type->code->bytes(value.value.get());
      value.type->code->fault(value.value.get());
    }
  const std::string written = blob_of(key, *result, "describe.fpfh");
  const auto again = read_blob(key, written);
  fuzz::require(again && blob_of(key, *again, "describe.fpfh") == written,
                "a result that was read is the same after it was written");
}
