#pragma once
/// The Metrics among the values with numbers that a run gave.

#include "plumb/engine/run/runner.hpp"
#include "plumb/slam/types.hpp"

namespace plumb {

struct MadeMetrics {
  std::string path;  ///< of the step
  std::shared_ptr<const Metrics> metrics;
};

inline std::vector<MadeMetrics> metrics_of(const RunResult& result) {
  std::vector<MadeMetrics> all;
  for (const MadeNumbers& made : result.numbers)
    if (made.value.type == &type_of<Metrics>())
      all.push_back({made.path, made.value.as<Metrics>()});
  return all;
}

}  // namespace plumb
