#include "plumb/plugin/manifest.hpp"

#include "../fuzz.hpp"
#include "plumb/plugin/registry.hpp"
#include "plumb/slam/types.hpp"

using namespace plumb;

namespace {

/// The types of SLAM are registered before any input is read, as they are in the command.
[[maybe_unused]] const Type& of_slam = type_of<Segment>();

/// In an input @ABI@ stands for this build's own tag, for a manifest of any other is not read on.
std::string of_this_build(std::string_view bytes) {
  constexpr std::string_view own = "@ABI@";
  std::string text(bytes);
  if (const auto at = text.find(own); at != text.npos) text.replace(at, own.size(), abi_tag());
  return text;
}

}  // namespace

PLUMB_FUZZ_READER(manifest) {
  const std::string text = manifest_text(read_manifest(of_this_build(bytes), "a.json"));
  fuzz::require(manifest_text(read_manifest(text, "b.json")) == text,
                "a manifest that was read is the same after it was written");
}
