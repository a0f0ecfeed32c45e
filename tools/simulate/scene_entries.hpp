#pragma once
/// The keys and values of a scene file, each with its place; and the file that holds given ones.

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "plumb/data/error.hpp"
#include "simulate/names.hpp"
#include "simulate/option.hpp"

namespace plumb::simulate {

struct SceneEntry {
  std::string key;
  std::optional<std::string> value;              ///< none of a list or a map
  std::vector<std::optional<std::string>> list;  ///< the same of each of its elements
  std::string place, value_place;                ///< file:line:column
};

/// What a scene file holds, in order. Throws Error with file:line:column for what is no map or
/// gives a key twice.
std::vector<SceneEntry> scene_entries(const std::filesystem::path& file);

/// The text of a value of `entry`, or of one in its list. Throws Error where there is none.
const std::string& scalar_of(const SceneEntry& entry, const std::optional<std::string>& value);

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

/// The options that `scene` gives, by key, each with its value.
using SceneValues = std::vector<std::pair<std::string, std::string>>;
template <class S>
SceneValues values_of(const S& scene, const std::vector<OptionOf<S>>& options) {
  SceneValues values;
  for (const auto& option : options)
    if (auto text = option_text(scene, option)) values.emplace_back(option.key, *std::move(text));
  return values;
}

/// A scene file: scene_mark, the values, and the files of `drift_from` if there are any.
std::string text_of_scene(const SceneValues& values,
                          const std::vector<std::string>& drift_from = {});

}  // namespace plumb::simulate
