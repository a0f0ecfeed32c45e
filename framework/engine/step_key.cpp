#include "plumb/engine/step_key.hpp"

#include <sys/stat.h>

#include "plumb/data/archive.hpp"

namespace plumb {

Hash128 step_key(const StepDescription& step, const ParameterValues& values) {
  Hasher hasher;
  hasher.text(step.name);
  hasher.bytes(&step.version, sizeof step.version);
  for (const auto& [name, value] : values) {  // a map: in order of name
    const ParameterDescription* parameter = step.parameter(name);
    if (parameter && !parameter->affects_result) continue;
    hasher.text(name);
    const std::size_t kind = value.index();
    hasher.bytes(&kind, sizeof kind);
    std::visit(
        [&](const auto& v) {
          using V = std::decay_t<decltype(v)>;
          if constexpr (std::is_same_v<V, std::string>) hasher.text(v);
          else if constexpr (!std::is_same_v<V, std::monostate>) hasher.bytes(&v, sizeof v);
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
    struct stat at{};
    if (stat(path->c_str(), &at) != 0) continue;
    const std::int64_t seen[] = {at.st_size, at.st_mtim.tv_sec, at.st_mtim.tv_nsec};
    hasher.bytes(seen, sizeof seen);
  }
  return hasher.hash();
}

Hash128 joined_key(const Hash128& a, const Hash128& b) {
  Hasher hasher;
  hasher.bytes(&a, sizeof a);
  hasher.bytes(&b, sizeof b);
  return hasher.hash();
}

}  // namespace plumb
