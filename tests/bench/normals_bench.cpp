/// Normals from the 30 nearest points, beside PCL's NormalEstimationOMP, one thread; both build
/// their tree.

#include <benchmark/benchmark.h>

#include "../../plugins/estimate/normals/normals.hpp"
#include "plumb/plugin/testing.hpp"
#include "scene.hpp"
#ifdef PLUMB_HAS_PCL
#include "pcl_twins.hpp"
#endif

namespace plumb::bench {
namespace {

const Cloud& scene() {
  static const Cloud cloud = street_segment(0);
  return cloud;
}

void say(benchmark::State& state) {
  state.SetLabel(scene_name());
  state.counters["points"] = static_cast<double>(scene().size());
  state.counters["time/point"] = benchmark::Counter(
      static_cast<double>(scene().size()),
      benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void Normals_ours(benchmark::State& state) {
  Cloud cloud = scene();
  for (auto _ : state) {
    TestContext one_thread;
    const SearchTree tree(cloud);
    estimate_normals(
        cloud, tree, {{}, 30}, [](std::size_t) { return Eigen::Vector3f(0, 0, 0); }, one_thread);
    benchmark::DoNotOptimize(cloud.nx.data());
  }
  say(state);
}
BENCHMARK(Normals_ours)->Unit(benchmark::kMillisecond);

#ifdef PLUMB_HAS_PCL
void Normals_pcl(benchmark::State& state) {
  const Cloud& c = scene();
  const twins::PclCloud twin(c.x, c.y, c.z, {}, {}, {});
  for (auto _ : state) benchmark::DoNotOptimize(twin.normals(30, 1));
  say(state);
}
BENCHMARK(Normals_pcl)->Unit(benchmark::kMillisecond);
#endif

}  // namespace
}  // namespace plumb::bench
