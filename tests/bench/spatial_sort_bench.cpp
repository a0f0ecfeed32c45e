/// Sorting points along a Hilbert curve, and what it brings: the 30 nearest of each point in the
/// order of the curve, beside the order of cells. Per point.

#include "../../plugins/filter/spatial_sort/hilbert.hpp"
#include "plumb/slam/geometry/search_tree.hpp"
#include "scene.hpp"

namespace plumb::bench {
namespace {

const Cloud& scene() { return thinned_segment(0, 0.3); }

void sorting(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(filter_spatial_sort::hilbert_order(scene()));
  per(state, "point", static_cast<double>(scene().size()));
}
BENCHMARK(sorting)->Name("spatial sort/CGAL")->Unit(benchmark::kMillisecond);

void ask(benchmark::State& state, const Cloud& cloud) {
  const SearchTree tree(cloud);
  SearchTree::Neighbour found[30];
  for (auto _ : state)
    for (std::size_t k = 0; k < cloud.size(); ++k)
      benchmark::DoNotOptimize(tree.nearest(cloud.point(k), 30, found));
  per(state, "point", static_cast<double>(cloud.size()));
}
void sorted(benchmark::State& state) {
  ask(state, select(scene(), filter_spatial_sort::hilbert_order(scene())));
}
BENCHMARK(sorted)->Name("30 nearest, in order/of the curve")->Unit(benchmark::kMillisecond);
void as_it_is(benchmark::State& state) { ask(state, scene()); }
BENCHMARK(as_it_is)->Name("30 nearest, in order/of the cells")->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace plumb::bench
