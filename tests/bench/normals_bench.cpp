/// Normals from the 30 nearest points, beside PCL's NormalEstimationOMP on one thread; both build
/// their tree.

#include "../../plugins/estimate/normals/normals.hpp"
#include "plumb/plugin/testing.hpp"
#include "plumb/slam/step.hpp"
#include "scene.hpp"
#ifdef PLUMB_HAS_PCL
#include "pcl_twins.hpp"
#endif

namespace plumb::bench {
namespace {

void ours(benchmark::State& state) {
  Cloud cloud = thinned_segment(0, 0.3);
  const auto origin = [](std::size_t) { return Eigen::Vector3f(0, 0, 0); };
  for (auto _ : state) {
    TestContext one_thread;
    estimate_normals::estimate_normals(cloud, SearchTree(cloud), {{}, 30}, origin, one_thread);
    benchmark::DoNotOptimize(cloud.nx.data());
  }
  per(state, "point", static_cast<double>(cloud.size()));
}
BENCHMARK(ours)->Name("normals/ours")->Unit(benchmark::kMillisecond);

#ifdef PLUMB_HAS_PCL
void pcl(benchmark::State& state) {
  const Cloud& cloud = thinned_segment(0, 0.3);
  const twins::PclCloud twin(cloud.x, cloud.y, cloud.z, {}, {}, {});
  for (auto _ : state) benchmark::DoNotOptimize(twin.normals(30, 1));
  per(state, "point", static_cast<double>(cloud.size()));
}
BENCHMARK(pcl)->Name("normals/PCL")->Unit(benchmark::kMillisecond);
#endif

}  // namespace
}  // namespace plumb::bench
