#pragma once
/// For tests of former names: a table for the steps of test_steps.hpp, and the cascade as it was
/// before it and as it is.

#include <stdexcept>

#include "plumb/pipeline/testing/test_steps.hpp"

namespace plumb::test {

inline const FormerNames& former() {
  static const FormerNames names = read_former_names(R"(# for tests
steps: {describe.points: describe.fpfh, edges.near: edges.overlap, prune.gone: prune.nowhere}
inputs: {edges.overlap: {clouds: segments}, measure.match_rmse: {graph: edges}}
outputs:
  segment.by_count: {cuts: ranges, start: poses}
  solve.pose_graph: {trajectory: poses}
  measure.match_rmse: {numbers: metrics}
parameters:
  filter.voxel_grid: {grid: leaf, leaf: keep_normals}
  segment.by_count: {length: frames}
  prune.distance: {reach: max}
choices:
  solve.pose_graph: {loss: {robust: huber, squares: none}}
defaults:
  describe.fpfh: {angle: 0.26 rad, radius: 2.5 m}
  prune.kmeans: {clusters: 5}
pipelines:
  cascade: {grid: voxel, coarse.reach: coarse.gate}
)",
                                                     "table.yaml");
  return names;
}

/// `text` with each first word of `pairs` exchanged for the second, at its first place.
inline std::string exchanged(std::string text,
                             const std::vector<std::pair<std::string, std::string>>& pairs) {
  for (const auto& [was, now] : pairs) {
    const auto at = text.find(was);
    if (at == std::string::npos) throw std::logic_error("no '" + was + "' in the text");
    text.replace(at, was.size(), now);
  }
  return text;
}

inline std::string cascade_of_now() {
  return exchanged(cascade,
                   {{"with: {frames: 30}}", "with: {frames: 30}}  # $leaf, grid: {"},
                    {"ranges: ranges}", "ranges: ranges.ranges}"},
                    {"with: {leaf: $voxel}", "with: {\"leaf\": $voxel, keep_normals: false}"},
                    {"describe.fpfh,", "describe.fpfh, with: {angle: 0.26 rad},"},
                    {"use: prune.kmeans,", "use: prune.kmeans, with: {clusters: 5},"},
                    {"start: {poses: drift.solved}", "start: {poses: drift.solved.poses}"},
                    {"metric: rmse,", "metric: rmse.metrics,"}});
}

inline std::string old_cascade() {
  return exchanged(
      cascade_of_now(),
      {{"with: {frames: 30}}", "with: {length: 30}}"},
       {"ranges: ranges.ranges}", "ranges: ranges.cuts}"},
       {"with: {\"leaf\": $voxel", "with: {\"grid\": $voxel"},
       {"describe.fpfh, with: {angle: 0.26 rad},", "describe.points,"},
       {"neighbours: {use: edges.overlap, from: {segments: segments, poses: ranges.poses}}",
        "neighbours: {use: edges.near, from: {clouds: segments, poses: ranges.start}}"},
       {"use: prune.kmeans, with: {clusters: 5},", "use: prune.kmeans,"},
       {"with: {max: $gate}", "with: {reach: $gate}"},
       {"with: {loss: huber}", "with: {loss: robust}"},
       {"start: {poses: drift.solved.poses}", "start: {poses: drift.solved.trajectory}"},
       {"from: {edges: edges, segments: segments, poses: solved}",
        "from: {graph: edges, segments: segments, poses: solved}"},
       {"metric: rmse.metrics,", "metric: rmse.numbers,"}});
}

/// The text of a plan without the places that its values came from.
inline std::string without_places(const Plan& plan) {
  std::string bare, text = plan.resolved;
  for (std::size_t begin = 0; begin < text.size();) {
    const auto end = text.find('\n', begin);
    const std::string line = text.substr(begin, end - begin);
    const std::string said = line.substr(0, line.find(" # "));
    bare += said.substr(0, said.find_last_not_of(' ') + 1) + "\n";
    begin = end + 1;
  }
  return bare;
}

}  // namespace plumb::test
