/// The overlap of two neighbouring segments in voxels of 1 m: building what is compared, and
/// comparing, beside PCL's octree whose leaves are asked point by point. Per point of both clouds.

#include "../../plugins/edges/overlap/voxels.hpp"
#include "scene.hpp"
#ifdef PLUMB_HAS_PCL
#include "pcl_space.hpp"
#endif

namespace plumb::bench {
namespace {

using edges_overlap::Lattice;
using edges_overlap::lattice_over;
using edges_overlap::overlap;
using edges_overlap::Voxels;
using edges_overlap::voxels_of;
using edges_overlap::world_box;

constexpr double size = 1;

const Cloud& end(std::size_t which) { return thinned_segment(which, 0.3); }

void say(benchmark::State& state) {
  per(state, "point", static_cast<double>(end(0).size() + end(1).size()));
}

Lattice lattice() {
  return lattice_over(
      {world_box(box_of(end(0)), segment_pose(0)), world_box(box_of(end(1)), segment_pose(1))},
      size);
}

void building(benchmark::State& state) {
  const Lattice over = lattice();
  for (auto _ : state)
    for (const std::size_t k : {0, 1})
      benchmark::DoNotOptimize(voxels_of(end(k), segment_pose(k), over));
  say(state);
}
BENCHMARK(building)->Name("overlap, building/ours")->Unit(benchmark::kMillisecond);

void comparing(benchmark::State& state) {
  const Voxels a = voxels_of(end(0), segment_pose(0), lattice()),
               b = voxels_of(end(1), segment_pose(1), lattice());
  for (auto _ : state) benchmark::DoNotOptimize(overlap(a, b));
  say(state);
  state.counters["overlap"] = overlap(a, b);
}
BENCHMARK(comparing)->Name("overlap, comparing/ours")->Unit(benchmark::kMicrosecond);

#ifdef PLUMB_HAS_PCL
twins::PclSpace in_world(std::size_t which) {
  Cloud cloud;
  const Motion motion(segment_pose(which));
  for (std::size_t k = 0; k < end(which).size(); ++k) cloud.add(motion * end(which).point(k));
  return {cloud.x, cloud.y, cloud.z};
}

void building_pcl(benchmark::State& state) {
  twins::PclSpace a = in_world(0), b = in_world(1);
  for (auto _ : state) a.build_octree(size), b.build_octree(size);
  say(state);
}
BENCHMARK(building_pcl)->Name("overlap, building/PCL")->Unit(benchmark::kMillisecond);

void comparing_pcl(benchmark::State& state) {
  twins::PclSpace a = in_world(0), b = in_world(1);
  a.build_octree(size), b.build_octree(size);
  std::size_t both = 0;
  for (auto _ : state) both = a.occupied_by(b) + b.occupied_by(a);
  say(state);
  state.counters["overlap"] =
      static_cast<double>(both) / static_cast<double>(end(0).size() + end(1).size());
}
BENCHMARK(comparing_pcl)->Name("overlap, comparing/PCL")->Unit(benchmark::kMicrosecond);
#endif

}  // namespace
}  // namespace plumb::bench
