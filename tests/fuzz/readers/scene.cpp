#include "simulate/scene.hpp"

#include "../fuzz.hpp"
#include "simulate/indoor_scene.hpp"

using namespace plumb;

PLUMB_FUZZ_READER(scene) {
  using namespace plumb::simulate;
  const auto file = fuzz::file_of(bytes, "a.yaml");
  const auto same = [](const std::string& text, auto read) {
    fuzz::require(scene_text(read(fuzz::file_of(text, "b.yaml"))) == text,
                  "a scene that was read is the same after it was written");
  };
  if (is_indoor_scene(file))
    same(scene_text(read_indoor_scene(file)), read_indoor_scene);
  else
    same(scene_text(read_scene(file)), read_scene);
}
