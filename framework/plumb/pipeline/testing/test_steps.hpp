#pragma once
/// For tests of pipelines: a registry of steps that do nothing, a folder for files, and a pipeline
/// that has everything.

#include "plumb/data/io/file_testing.hpp"
#include "plumb/pipeline/reader.hpp"

namespace plumb::test {

/// Steps named like the real ones, with their ports and parameters: source.sequence,
/// filter.distance, segment.by_count, segment.merge, filter.voxel_grid, describe.fpfh,
/// edges.overlap, edges.union, match.fpfh_mutual, prune.distance, prune.kmeans, prune.ransac,
/// solve.pose_graph, measure.match_rmse, stitch.sliding_window, register.icp,
/// apply.chain, write.trajectory.
const Registry& registry();
/// Its two halves.
void add_cloud_steps(Registry& registry);
void add_graph_steps(Registry& registry);

/// A folder of its own for pipelines written in a test, removed afterwards.
using Folder = io::TestFolder;

/// A cascade of two stages with all that a pipeline may have.
inline const std::string cascade = R"(plumb: 1
name: cascade
about: a test
parameters:
  input: {type: path, about: the sequence}
  voxel: {type: length, default: 0.3 m, about: leaf}
steps:
  sequence: {use: source.sequence, with: {path: $input}}
  ranges:   {use: segment.by_count, from: sequence.trajectory, with: {frames: 30}}
  ranged:   {use: filter.distance, from: sequence.frames, with: {min: 1 m}}
  merged:   {use: segment.merge, from: {frames: ranged, ranges: ranges}}
  segments: {use: filter.voxel_grid, from: merged, with: {leaf: $voxel}}
  fpfh:     {use: describe.fpfh, from: segments}
  drift:
    steps:
      neighbours: {use: edges.overlap, from: {segments: segments, poses: ranges.poses}}
      matches:    {use: match.fpfh_mutual, from: {edges: neighbours, features: fpfh}}
      solved:     {use: solve.pose_graph, from: {poses: ranges, matches: matches}}
  edges: {use: edges.overlap, from: {segments: segments, poses: drift.solved}}
  coarse:
    repeat:
      passes:
        gate: [4 m, 2 m, 1 m]
      carry: {poses: solved}
      until: {all: [{metric: rmse, falls_by_less_than: 2 %}]}
      at_least: 2
      at_most: 6
      if_exhausted: warn
    start: {poses: drift.solved}
    steps:
      found:  {use: match.fpfh_mutual, from: {edges: edges, features: fpfh}}
      near:   {use: prune.distance, from: {matches: found, poses: poses}, with: {max: $gate}}
      kept:   {use: prune.kmeans, from: {matches: near, poses: poses}}
      solved: {use: solve.pose_graph, from: {matches: kept, poses: poses}, with: {loss: huber}}
      rmse:   {use: measure.match_rmse, from: {edges: edges, segments: segments, poses: solved}, with: {cap: 0.5 m}}
  written: {use: write.trajectory, from: sequence}
)";

}  // namespace plumb::test
