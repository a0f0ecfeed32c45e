#pragma once
/// What the benchmarks run on: a street of the simulator, cut into segments as a pipeline for cars
/// does.

#include <benchmark/benchmark.h>

#include "plumb/slam/cloud.hpp"
#include "plumb/slam/geometry/pose.hpp"

namespace plumb::bench {

/// To be called before anything else: a twentieth of the columns, so that all benchmarks run in
/// seconds. Their times then say nothing.
void make_scene_small();

/// Segment 0 or 1: five scans of 64 x 1024 rays, 3.4 m apart, merged in the coordinates of the
/// middle one, as the sensor gave them. The two follow each other and overlap.
const Cloud& merged_segment(std::size_t which);

/// The same, thinned to one point per cell of edge `leaf` [m].
const Cloud& thinned_segment(std::size_t which, double leaf);

/// The same with normals (30 nearest within 1 m, turned to the segment's origin).
const Cloud& segment_with_normals(std::size_t which, double leaf = 0.3);

/// T_world_segment of the two.
Pose segment_pose(std::size_t which);

/// States what is counted: `n` things called `what` a round. The counter `each` is the time of one
/// [s].
inline void per(benchmark::State& state, const char* what, double n) {
  state.SetLabel(what);
  state.counters["n"] = n;
  state.counters["each"] = benchmark::Counter(
      n, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

}  // namespace plumb::bench
