/// Removal of outliers (mean_k 20, stddev_mul_thresh 2) beside PCL's StatisticalOutlierRemoval;
/// both build their tree.

#include "../../plugins/filter/statistical_outlier/statistical_outlier.hpp"
#include "scene.hpp"
#include "shared/parallel/loop_testing.hpp"
#ifdef PLUMB_HAS_PCL
#include "pcl_twins.hpp"
#endif

namespace plumb::bench {
namespace {

constexpr double leaf = 0.1;

void ours(benchmark::State& state) {
  const Cloud& cloud = thinned_segment(0, leaf);
  std::size_t left = 0;
  for (auto _ : state)
    left = filter_statistical_outlier::not_beyond(
               filter_statistical_outlier::mean_distances(cloud, SearchTree(cloud), 20,
                                                          parallel::in_order),
               2)
               .size();
  per(state, "point", static_cast<double>(cloud.size()));
  state.counters["left"] = static_cast<double>(left);
}
BENCHMARK(ours)->Name("statistical_outlier/ours")->Unit(benchmark::kMillisecond);

#ifdef PLUMB_HAS_PCL
void pcl(benchmark::State& state) {
  const Cloud& cloud = thinned_segment(0, leaf);
  const twins::PclCloud twin(cloud.x, cloud.y, cloud.z, {}, {}, {});
  std::size_t left = 0;
  for (auto _ : state) left = twin.without_outliers(20, 2).size();
  per(state, "point", static_cast<double>(cloud.size()));
  state.counters["left"] = static_cast<double>(left);
}
BENCHMARK(pcl)->Name("statistical_outlier/PCL")->Unit(benchmark::kMillisecond);
#endif

}  // namespace
}  // namespace plumb::bench
