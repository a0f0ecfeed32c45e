/// Thinning a merged segment beside PCL's VoxelGrid; the argument is the leaf in centimetres.

#include "../../plugins/filter/voxel_grid/voxel_grid.hpp"
#include "scene.hpp"
#ifdef PLUMB_HAS_PCL
#include "pcl_space.hpp"
#endif

namespace plumb::bench {
namespace {

double leaf_of(const benchmark::State& state) { return 0.01 * static_cast<double>(state.range(0)); }

void ours(benchmark::State& state) {
  const Cloud& cloud = merged_segment(0);
  std::size_t left = 0;
  for (auto _ : state) left = filter_voxel_grid::thin(cloud, {}, {}, leaf_of(state)).cloud.size();
  per(state, "point", static_cast<double>(cloud.size()));
  state.counters["left"] = static_cast<double>(left);
}
BENCHMARK(ours)
    ->Name("voxel_grid/ours")
    ->ArgName("leaf [cm]")
    ->Arg(10)
    ->Arg(30)
    ->Unit(benchmark::kMillisecond);

#ifdef PLUMB_HAS_PCL
void pcl(benchmark::State& state) {
  const Cloud& cloud = merged_segment(0);
  const twins::PclSpace twin(cloud.x, cloud.y, cloud.z);
  std::size_t left = 0;
  for (auto _ : state) left = twin.voxel_grid(static_cast<float>(leaf_of(state)));
  per(state, "point", static_cast<double>(cloud.size()));
  state.counters["left"] = static_cast<double>(left);
}
BENCHMARK(pcl)
    ->Name("voxel_grid/PCL")
    ->ArgName("leaf [cm]")
    ->Arg(10)
    ->Arg(30)
    ->Unit(benchmark::kMillisecond);
#endif

}  // namespace
}  // namespace plumb::bench
