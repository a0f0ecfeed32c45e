#pragma once
/// For tests of stores: small results, and the files that hold them.

#include <filesystem>
#include <vector>

#include "plumb/data/toy_testing.hpp"
#include "plumb/store/store.hpp"

namespace plumb {

/// A result that is known by `x`: three outputs, one of several values and one of none, a count and
/// a warning.
inline StoredResult small_result(double x) {
  toy::Metrics metrics;
  metrics.add("rmse", x, "m");
  return {{{any_value(toy::Poses{{x, 2, 3}})}, {any_value(metrics), any_value(metrics)}, {}},
          {{"points dropped", 7}},
          {"poor"}};
}

inline double x_of(const StoredResult& stored) {
  return stored.outputs[0][0].as<toy::Poses>()->places[0];
}

inline std::vector<std::filesystem::path> blobs_in(const std::filesystem::path& store) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(store / "blobs"))
    if (entry.is_regular_file()) files.push_back(entry.path());
  return files;
}

}  // namespace plumb
