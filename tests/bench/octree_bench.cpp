/// The overlap of two neighbouring segments in leaves of 1 m by CGAL's octrees, building and
/// comparing, beside edges.overlap. Per point of both clouds.

#include "../../plugins/edges/overlap/voxels.hpp"
#include "../../plugins/edges/overlap_octree/octree.hpp"
#include "scene.hpp"

namespace plumb::bench {
namespace {

using edges_overlap_octree::CloudOctree;

const Cloud& end(std::size_t which) { return thinned_segment(which, 0.3); }

overlapping::Lattice lattice() {
  return overlapping::lattice_over({overlapping::world_box(box_of(end(0)), segment_pose(0)),
                                    overlapping::world_box(box_of(end(1)), segment_pose(1))},
                                   1);
}
void say(benchmark::State& state, double overlap) {
  per(state, "point", static_cast<double>(end(0).size() + end(1).size()));
  state.counters["overlap"] = overlap;
}
template <class Held>
void build_and_compare(benchmark::State& state,
                       Held (*hold)(const Cloud&, const Pose&, const overlapping::Lattice&),
                       double (*overlap)(const Held&, const Held&)) {
  const auto over = lattice();
  double found = 0;
  for (auto _ : state) {
    const Held a = hold(end(0), segment_pose(0), over), b = hold(end(1), segment_pose(1), over);
    found = overlap(a, b);
  }
  say(state, found);
}

void by_octrees(benchmark::State& state) {
  build_and_compare<CloudOctree>(
      state,
      [](const Cloud& cloud, const Pose& pose, const overlapping::Lattice& over) {
        return CloudOctree(cloud, pose, over);
      },
      [](const CloudOctree& a, const CloudOctree& b) {
        return edges_overlap_octree::overlap(a, b);
      });
}
BENCHMARK(by_octrees)->Name("overlap by octrees/CGAL")->Unit(benchmark::kMillisecond);

void by_voxels(benchmark::State& state) {
  build_and_compare<edges_overlap::Voxels>(
      state,
      [](const Cloud& cloud, const Pose& pose, const overlapping::Lattice& over) {
        return edges_overlap::voxels_of(cloud, pose, over);
      },
      [](const edges_overlap::Voxels& a, const edges_overlap::Voxels& b) {
        return edges_overlap::overlap(a, b);
      });
}
BENCHMARK(by_voxels)->Name("overlap by octrees/edges.overlap")->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace plumb::bench
