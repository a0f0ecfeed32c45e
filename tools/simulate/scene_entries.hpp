#pragma once
/// The keys and values of a scene file, each with its place.

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "plumb/data/error.hpp"
#include "simulate/names.hpp"
#include "simulate/option.hpp"

namespace plumb::simulate {

struct SceneEntry {
  std::string key;
  YAML::Node value;
  std::string place, value_place;  ///< file:line:column
};

/// What a scene file holds, in order. Throws Error with file:line:column for what is no map or
/// gives a key twice.
std::vector<SceneEntry> scene_entries(const std::filesystem::path& file);

/// The text of a value of `entry`. Throws Error where it is a list or a map.
std::string scalar_of(const SceneEntry& entry, const YAML::Node& value);

/// The option that the entry sets. Throws Error for a key that is none of theirs, nor of `others`.
template <class S>
const OptionOf<S>& option_of(const SceneEntry& entry, const std::vector<OptionOf<S>>& options,
                             const std::vector<std::string>& others = {}) {
  const auto found = std::find_if(options.begin(), options.end(),
                                  [&](const auto& option) { return entry.key == option.key; });
  if (found != options.end()) return *found;
  std::vector<std::string> known = others;
  for (const auto& option : options) known.emplace_back(option.key);
  throw Error(entry.place + ": unknown option '" + entry.key + "'; " +
              suggestion(entry.key, known));
}

}  // namespace plumb::simulate
