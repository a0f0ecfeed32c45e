#include "simulate/scene_entries.hpp"

#include <yaml-cpp/yaml.h>

#include <set>

#include "plumb/data/io/file_text.hpp"
#include "simulate/indoor_scene.hpp"
#include "simulate/route.hpp"
#include "simulate/scene.hpp"

namespace plumb::simulate {
namespace {

std::string place_of(const std::filesystem::path& file, const YAML::Mark& mark) {
  return file.string() + ":" + std::to_string(mark.line + 1) + ":" +
         std::to_string(mark.column + 1);
}

std::optional<std::string> scalar_in(const YAML::Node& node) {
  if (!node.IsScalar()) return std::nullopt;
  return node.Scalar();
}

std::vector<std::optional<std::string>> list_in(const YAML::Node& node) {
  std::vector<std::optional<std::string>> list;
  if (node.IsSequence())
    for (const auto& element : node) list.push_back(scalar_in(element));
  return list;
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
    SceneEntry entry{scalar_in(pair.first).value_or("?"), scalar_in(pair.second),
                     list_in(pair.second), place_of(file, pair.first.Mark()),
                     place_of(file, pair.second.Mark())};
    if (!seen.insert(entry.key).second)
      throw Error(entry.place + ": '" + entry.key + "' is given twice; leave one of them out");
    entries.push_back(std::move(entry));
  }
  return entries;
}

const std::string& scalar_of(const SceneEntry& entry, const std::optional<std::string>& value) {
  if (!value)
    throw Error(entry.value_place + ": '" + entry.key + "' takes one value; write '" + entry.key +
                ": VALUE'");
  return *value;
}

std::string text_of_scene(const SceneValues& values, const std::vector<std::string>& drift_from) {
  YAML::Emitter out;
  out << YAML::BeginMap;
  for (const auto& [key, value] : values) out << YAML::Key << key << YAML::Value << value;
  if (!drift_from.empty()) {
    out << YAML::Key << "drift_from" << YAML::Value << YAML::Flow << YAML::BeginSeq;
    for (const std::string& file : drift_from) out << file;
    out << YAML::EndSeq;
  }
  out << YAML::EndMap;
  return std::string(scene_mark) + ", with all it was made from; give it back to repeat it.\n" +
         out.c_str() + "\n";
}

}  // namespace plumb::simulate
