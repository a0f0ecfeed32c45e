#include "plumb/plugin/manifest.hpp"

#include "../fuzz.hpp"

using namespace plumb;

PLUMB_FUZZ_READER(manifest) {
  const std::string text = manifest_text(read_manifest(std::string(bytes), "a.json"));
  fuzz::require(manifest_text(read_manifest(text, "b.json")) == text,
                "a manifest that was read is the same after it was written");
}
