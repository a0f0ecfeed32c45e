/// Normals from the 30 nearest points by CGAL's jets of degree 2, beside planes; both build their
/// tree.

#include "../../plugins/estimate/normals/normals.hpp"
#include "../../plugins/estimate/normals_jet/jet.hpp"
#include "plumb/plugin/testing.hpp"
#include "plumb/slam/step.hpp"
#include "scene.hpp"

namespace plumb::bench {
namespace {

Eigen::Vector3f origin(std::size_t) { return {0, 0, 0}; }

void jets(benchmark::State& state) {
  Cloud cloud = thinned_segment(0, 0.3);
  for (auto _ : state) {
    TestContext one_thread;
    estimate_normals_jet::jet_normals(cloud, SearchTree(cloud), {{}, 30}, {}, origin, one_thread);
    benchmark::DoNotOptimize(cloud.nx.data());
  }
  per(state, "point", static_cast<double>(cloud.size()));
}
BENCHMARK(jets)->Name("normals of curved surfaces/CGAL")->Unit(benchmark::kMillisecond);

void planes(benchmark::State& state) {
  Cloud cloud = thinned_segment(0, 0.3);
  for (auto _ : state) {
    TestContext one_thread;
    estimate_normals::estimate_normals(cloud, SearchTree(cloud), {{}, 30}, origin, one_thread);
    benchmark::DoNotOptimize(cloud.nx.data());
  }
  per(state, "point", static_cast<double>(cloud.size()));
}
BENCHMARK(planes)
    ->Name("normals of curved surfaces/estimate.normals")
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace plumb::bench
