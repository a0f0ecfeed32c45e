#include "plumb/engine/plan/step_key.hpp"

#include <new>

#include "plumb/data/archive.hpp"
#include "plumb/data/io/file_identity.hpp"

namespace plumb {
namespace {

/// Raised when the engine gives steps something else for the same inputs. 2: seeds of the inputs
/// alone. 3: of the parts of them that are seen.
constexpr int engine_rule = 3;

}  // namespace

Hash128 step_key(const StepDescription& step, const ParameterValues& values) {
  Hasher hasher;
  hasher.bytes(&engine_rule, sizeof engine_rule);
  hasher.text(step.name);
  hasher.bytes(&step.version, sizeof step.version);
  if (!step.across_builds) hasher.text(step.build);
  for (const auto& [name, value] : values) {  // a map: in order of name
    const ParameterDescription* parameter = step.parameter(name);
    if (parameter && !parameter->affects_result) continue;
    hasher.text(name);
    const std::size_t kind = value.index();
    hasher.bytes(&kind, sizeof kind);
    std::visit(
        [&](const auto& v) {
          using V = std::decay_t<decltype(v)>;
          if constexpr (std::is_same_v<V, std::string>)
            hasher.text(v);
          else if constexpr (!std::is_same_v<V, std::monostate>)
            hasher.bytes(&v, sizeof v);
        },
        value);
  }
  return hasher.hash();
}

Hash128 files_key(const StepDescription& step, const ParameterValues& values) {
  Hasher hasher;
  for (const auto& [name, value] : values) {
    const ParameterDescription* parameter = step.parameter(name);
    const auto* path = std::get_if<std::string>(&value);
    if (!parameter || parameter->kind != ParameterKind::path || !path || path->empty()) continue;
    hasher.text(*path);
    io::add_identity(hasher, *path);
  }
  return hasher.hash();
}

Hash128 joined_key(const Hash128& a, const Hash128& b) {
  Hasher hasher;
  hasher.bytes(&a, sizeof a);
  hasher.bytes(&b, sizeof b);
  return hasher.hash();
}

std::string sentence_of(const std::exception& thrown) {
  return dynamic_cast<const std::bad_alloc*>(&thrown)
             ? "memory is used up; give smaller segments or a larger voxel, or more memory"
             : thrown.what();
}

}  // namespace plumb
