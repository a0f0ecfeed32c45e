/// FPFH with the normals given, beside PCL's FPFHEstimationOMP at equal radius and keypoints, one
/// thread. Per point of the cloud: each one's histogram is made once, keypoint or not. The
/// arguments are the radius and the spacing of keypoints in decimetres; 0: every point is one.

#include <numeric>

#include "../../plugins/describe/fpfh/fpfh.hpp"
#include "plumb/plugin/testing.hpp"
#include "plumb/slam/step.hpp"
#include "scene.hpp"
#include "shared/keypoints/one_per_voxel.hpp"
#ifdef PLUMB_HAS_PCL
#include "pcl_twins.hpp"
#endif

namespace plumb::bench {
namespace {

double radius_of(const benchmark::State& state) {
  return 0.1 * static_cast<double>(state.range(0));
}

std::vector<std::uint32_t> keys_of(const benchmark::State& state, const Cloud& cloud) {
  if (state.range(1) > 0)
    return keypoints::one_per_voxel(cloud, 0.1 * static_cast<double>(state.range(1)));
  std::vector<std::uint32_t> all(cloud.size());
  std::iota(all.begin(), all.end(), 0);
  return all;
}

void say(benchmark::State& state, const Cloud& cloud, const std::vector<std::uint32_t>& keys) {
  per(state, "point", static_cast<double>(cloud.size()));
  state.counters["keypoints"] = static_cast<double>(keys.size());
}

void ours(benchmark::State& state) {
  const Cloud& cloud = segment_with_normals(0);
  const auto keys = keys_of(state, cloud);
  describe_fpfh::FpfhOptions options;
  options.radius = radius_of(state);
  for (auto _ : state) {
    TestContext one_thread;
    benchmark::DoNotOptimize(describe_fpfh::fpfh(cloud, keys, options, one_thread));
  }
  say(state, cloud, keys);
}
BENCHMARK(ours)
    ->Name("fpfh/ours")
    ->ArgNames({"radius [dm]", "spacing [dm]"})
    ->Args({15, 8})
    ->Args({25, 8})
    ->Args({25, 0})
    ->Unit(benchmark::kMillisecond);

#ifdef PLUMB_HAS_PCL
void pcl(benchmark::State& state) {
  const Cloud& cloud = segment_with_normals(0);
  const auto keys = keys_of(state, cloud);
  const twins::PclCloud twin(cloud.x, cloud.y, cloud.z, cloud.nx, cloud.ny, cloud.nz);
  for (auto _ : state) benchmark::DoNotOptimize(twin.fpfh(keys, radius_of(state), 1));
  say(state, cloud, keys);
}
BENCHMARK(pcl)
    ->Name("fpfh/PCL")
    ->ArgNames({"radius [dm]", "spacing [dm]"})
    ->Args({15, 8})
    ->Args({25, 8})
    ->Args({25, 0})
    ->Unit(benchmark::kMillisecond);
#endif

}  // namespace
}  // namespace plumb::bench
