/// FPFH at the key points of a segment, the normals given, beside PCL's FPFHEstimationOMP at equal
/// radius and threads.

#include <benchmark/benchmark.h>

#include "../../plugins/describe/fpfh/fpfh.hpp"
#include "../../plugins/describe/fpfh/key_points.hpp"
#include "plumb/plugin/testing.hpp"
#include "scene.hpp"
#ifdef PLUMB_HAS_PCL
#include "pcl_twins.hpp"
#endif

namespace plumb::bench {
namespace {

struct Scene {
  Cloud cloud = street_segment_with_normals(0);
  std::vector<std::uint32_t> keys = key_points(cloud, 0.8);
  static const Scene& get() {
    static const Scene scene;
    return scene;
  }
};

/// Time of one call, by point of the cloud: each point's histogram is made once, whether it is a
/// key point or not.
void say(benchmark::State& state) {
  const Scene& scene = Scene::get();
  state.SetLabel(scene_name() + ", radius " + std::to_string(state.range(0)) + " dm");
  state.counters["points"] = static_cast<double>(scene.cloud.size());
  state.counters["key points"] = static_cast<double>(scene.keys.size());
  state.counters["time/point"] = benchmark::Counter(
      static_cast<double>(scene.cloud.size()),
      benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void Fpfh_ours(benchmark::State& state) {
  const Scene& scene = Scene::get();
  FpfhOptions options;
  options.radius = 0.1 * static_cast<double>(state.range(0));
  for (auto _ : state) {
    TestContext one_thread;
    benchmark::DoNotOptimize(fpfh(scene.cloud, scene.keys, options, one_thread));
  }
  say(state);
}
BENCHMARK(Fpfh_ours)->Arg(15)->Arg(25)->Arg(30)->Unit(benchmark::kMillisecond);

#ifdef PLUMB_HAS_PCL
void Fpfh_pcl(benchmark::State& state) {
  const Scene& scene = Scene::get();
  const Cloud& c = scene.cloud;
  const twins::PclCloud twin(c.x, c.y, c.z, c.nx, c.ny, c.nz);
  for (auto _ : state)
    benchmark::DoNotOptimize(twin.fpfh(scene.keys, 0.1 * static_cast<double>(state.range(0)), 1));
  say(state);
}
BENCHMARK(Fpfh_pcl)->Arg(15)->Arg(25)->Arg(30)->Unit(benchmark::kMillisecond)->Iterations(1);
#endif

}  // namespace
}  // namespace plumb::bench
