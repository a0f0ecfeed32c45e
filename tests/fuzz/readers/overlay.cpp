#include <sstream>

#include "../fuzz.hpp"
#include "plumb/pipeline/reader.hpp"
#include "plumb/pipeline/testing/test_steps.hpp"

using namespace plumb;

/// A preset laid over a whole pipeline, then values as --set takes them, one a line.
PLUMB_FUZZ_READER(overlay) {
  const auto parts = fuzz::parts_of(bytes, 2);
  Overlay overlay;
  if (!parts[0].empty()) overlay.presets = {fuzz::file_of(parts[0], "preset.yaml")};
  std::istringstream sets{std::string(parts[1])};
  for (std::string set; std::getline(sets, set);) overlay.sets.push_back(set);
  read_pipeline(fuzz::file_of(test::cascade, "pipeline.yaml"), overlay, test::registry());
}
