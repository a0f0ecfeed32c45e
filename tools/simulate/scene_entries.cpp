#include "simulate/scene_entries.hpp"

#include <set>

#include "plumb/data/io/file_text.hpp"
#include "simulate/indoor_scene.hpp"
#include "simulate/route.hpp"

namespace plumb::simulate {
namespace {

std::string place_of(const std::filesystem::path& file, const YAML::Mark& mark) {
  return file.string() + ":" + std::to_string(mark.line + 1) + ":" +
         std::to_string(mark.column + 1);
}

std::vector<std::string> shipped_scenes() {
  std::vector<std::string> names = route_names();
  names.insert(names.end(), indoor_names().begin(), indoor_names().end());
  return names;
}

std::string text_of(const std::filesystem::path& file) try {
  constexpr std::uint64_t most = 64 << 10;
  return std::string(io::FileBytes(file, most, "scene").view());
} catch (const Error& e) {
  throw Error(std::string(e.what()) +
              "; name a scene file or one of: " + suggestion("", shipped_scenes()));
}

}  // namespace

std::vector<SceneEntry> scene_entries(const std::filesystem::path& file) {
  YAML::Node root;
  try {
    root = YAML::Load(text_of(file));
  } catch (const YAML::Exception& e) {
    throw Error(place_of(file, e.mark) + ": " + e.msg + "; correct the YAML");
  }
  if (!root.IsMap())
    throw Error(file.string() + ": is not a map of options; write lines such as 'path: city_loop'");
  std::set<std::string> seen;
  std::vector<SceneEntry> entries;
  for (const auto& pair : root) {
    SceneEntry entry{pair.first.IsScalar() ? pair.first.Scalar() : "?", pair.second,
                     place_of(file, pair.first.Mark()), place_of(file, pair.second.Mark())};
    if (!seen.insert(entry.key).second)
      throw Error(entry.place + ": '" + entry.key + "' is given twice; leave one of them out");
    entries.push_back(std::move(entry));
  }
  return entries;
}

std::string scalar_of(const SceneEntry& entry, const YAML::Node& value) {
  if (!value.IsScalar())
    throw Error(entry.value_place + ": '" + entry.key + "' takes one value; write '" + entry.key +
                ": VALUE'");
  return value.Scalar();
}

}  // namespace plumb::simulate
