/// Scenes as YAML: a flat map of options.

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <fstream>
#include <set>

#include "plumb/data/error.hpp"
#include "simulate/names.hpp"
#include "simulate/route.hpp"
#include "simulate/scene.hpp"

namespace plumb::simulate {
namespace {

namespace fs = std::filesystem;

std::string place_of(const fs::path& file, const YAML::Mark& mark) {
  return file.string() + ":" + std::to_string(mark.line + 1) + ":" +
         std::to_string(mark.column + 1);
}

/// A file named in a scene, found from the scene's own folder.
std::string beside(const fs::path& scene, const std::string& named) {
  return (fs::absolute(scene).parent_path() / named).lexically_normal().string();
}

std::string text_of(const fs::path& file, const std::string& key, const YAML::Node& value) {
  if (!value.IsScalar())
    throw Error(place_of(file, value.Mark()) + ": '" + key + "' takes one value; write '" + key +
                ": VALUE'");
  return value.Scalar();
}

void set_drift_from(Scene& scene, const fs::path& file, const YAML::Node& value) {
  if (!value.IsSequence() || value.size() != 2)
    throw Error(place_of(file, value.Mark()) +
                ": 'drift_from' takes two files; write [odometry.tum, truth.tum]");
  scene.drift_odometry = beside(file, text_of(file, "drift_from", value[0]));
  scene.drift_truth = beside(file, text_of(file, "drift_from", value[1]));
}

/// The quantity with a unit, such that it reads back as the same double.
std::string exactly(double value, const Option& option) {
  std::string text = written(value, option.quantity);
  Scene back;
  set(back, option, text, false, "");
  const auto same = [&](auto member) {
    if constexpr (std::is_same_v<std::decay_t<decltype(back.*member)>, double> ||
                  std::is_same_v<std::decay_t<decltype(back.*member)>, std::optional<double>>)
      return back.*member == value;
    else
      return false;
  };
  if (std::visit(same, option.field)) return text;
  return shortest(value) + " " + si_symbol(option.quantity);
}

}  // namespace

const char* const scene_mark = "# A scene of plumb simulate";

Scene read_scene(const fs::path& file) {
  YAML::Node root;
  try {
    root = YAML::LoadFile(file.string());
  } catch (const YAML::BadFile&) {
    throw Error(file.string() + ": cannot be opened; name a scene file or one of: " +
                suggestion("", route_names()));
  } catch (const YAML::Exception& e) {
    throw Error(place_of(file, e.mark) + ": " + e.msg + "; correct the YAML");
  }
  if (!root.IsMap())
    throw Error(file.string() + ": is no map of options; write lines such as 'path: city_loop'");

  std::vector<std::string> known{"drift_from"};
  for (const Option& option : options()) known.emplace_back(option.key);
  std::set<std::string> seen;
  Scene scene;
  for (const auto& entry : root) {
    const YAML::Node &key_node = entry.first, &value = entry.second;
    const std::string place = place_of(file, key_node.Mark());
    const std::string key = key_node.IsScalar() ? key_node.Scalar() : "?";
    if (!seen.insert(key).second)
      throw Error(place + ": '" + key + "' is given twice; leave one of them out");
    if (key == "drift_from") {
      set_drift_from(scene, file, value);
      continue;
    }
    const auto option = std::find_if(options().begin(), options().end(),
                                     [&](const Option& o) { return key == o.key; });
    if (option == options().end())
      throw Error(place + ": unknown option '" + key + "'; " + suggestion(key, known));
    set(scene, *option, text_of(file, key, value), false, place_of(file, value.Mark()));
  }
  if (follows_file(scene)) {
    if (!scene.path.ends_with(".tum"))
      throw Error(file.string() + ": path '" + scene.path + "' is no route and no .tum file; " +
                  suggestion(scene.path, route_names()));
    scene.path = beside(file, scene.path);
  }
  return scene;
}

std::string scene_text(const Scene& scene) {
  YAML::Emitter out;
  out << YAML::BeginMap;
  for (const Option& option : options()) {
    const auto write = [&](auto member) {
      const auto& value = scene.*member;
      using T = std::decay_t<decltype(value)>;
      const auto entry = [&](const std::string& text) {
        out << YAML::Key << option.key << YAML::Value << text;
      };
      if constexpr (std::is_same_v<T, std::string>)
        entry(value);
      else if constexpr (std::is_same_v<T, double>)
        entry(exactly(value, option));
      else if constexpr (std::is_same_v<T, std::int64_t>)
        entry(std::to_string(value));
      else if constexpr (std::is_same_v<T, std::optional<double>>) {
        if (value) entry(exactly(*value, option));
      } else if (value)
        entry(std::to_string(*value));
    };
    std::visit(write, option.field);
  }
  if (!scene.drift_odometry.empty())
    out << YAML::Key << "drift_from" << YAML::Value << YAML::Flow << YAML::BeginSeq
        << scene.drift_odometry << scene.drift_truth << YAML::EndSeq;
  out << YAML::EndMap;
  return std::string(scene_mark) + ", with all it was made from; give it back to repeat it.\n" +
         out.c_str() + "\n";
}

}  // namespace plumb::simulate
