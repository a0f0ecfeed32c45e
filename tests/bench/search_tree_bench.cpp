/// The search tree in space beside nanoflann: building, the 30 nearest, all within 1 m (unsorted).
/// Per point.

#include "plumb/slam/geometry/search_tree.hpp"
#include "scene.hpp"
#ifdef PLUMB_HAS_NANOFLANN
#include <nanoflann.hpp>
#endif

namespace plumb::bench {
namespace {

constexpr std::size_t nearest = 30;
constexpr float radius = 1;

const Cloud& scene() { return thinned_segment(0, 0.3); }
void say(benchmark::State& state) { per(state, "point", static_cast<double>(scene().size())); }

void building(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(SearchTree(scene()));
  say(state);
}
BENCHMARK(building)->Name("search tree, building/ours")->Unit(benchmark::kMillisecond);

void the_nearest(benchmark::State& state) {
  const SearchTree tree(scene());
  SearchTree::Neighbour found[nearest];
  for (auto _ : state)
    for (std::size_t k = 0; k < scene().size(); ++k)
      benchmark::DoNotOptimize(tree.nearest(scene().point(k), nearest, found));
  say(state);
}
BENCHMARK(the_nearest)->Name("search tree, 30 nearest/ours")->Unit(benchmark::kMillisecond);

void all_within(benchmark::State& state) {
  const SearchTree tree(scene());
  std::vector<SearchTree::Neighbour> found;
  for (auto _ : state)
    for (std::size_t k = 0; k < scene().size(); ++k) {
      tree.within(scene().point(k), radius, found, false);
      benchmark::DoNotOptimize(found.data());
    }
  say(state);
}
BENCHMARK(all_within)->Name("search tree, within 1 m/ours")->Unit(benchmark::kMillisecond);

#ifdef PLUMB_HAS_NANOFLANN
struct Points {
  const Cloud& cloud;
  std::size_t kdtree_get_point_count() const { return cloud.size(); }
  float kdtree_get_pt(std::size_t k, std::size_t axis) const {
    return axis == 0 ? cloud.x[k] : axis == 1 ? cloud.y[k] : cloud.z[k];
  }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};
using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Points>,
                                                 Points, 3, std::uint32_t>;

void building_flann(benchmark::State& state) {
  const Points points{scene()};
  for (auto _ : state) {
    Tree tree(3, points, {10});
    tree.buildIndex();
    benchmark::DoNotOptimize(&tree);
  }
  say(state);
}
BENCHMARK(building_flann)->Name("search tree, building/nanoflann")->Unit(benchmark::kMillisecond);

void the_nearest_flann(benchmark::State& state) {
  const Points points{scene()};
  Tree tree(3, points, {10});
  tree.buildIndex();
  std::uint32_t index[nearest];
  float squared[nearest];
  for (auto _ : state)
    for (std::size_t k = 0; k < scene().size(); ++k)
      benchmark::DoNotOptimize(tree.knnSearch(scene().point(k).data(), nearest, index, squared));
  say(state);
}
BENCHMARK(the_nearest_flann)
    ->Name("search tree, 30 nearest/nanoflann")
    ->Unit(benchmark::kMillisecond);

void all_within_flann(benchmark::State& state) {
  const Points points{scene()};
  Tree tree(3, points, {10});
  tree.buildIndex();
  std::vector<std::pair<std::uint32_t, float>> found;
  nanoflann::SearchParams unsorted;
  unsorted.sorted = false;
  for (auto _ : state)
    for (std::size_t k = 0; k < scene().size(); ++k) {
      const Eigen::Vector3f at = scene().point(k);
      benchmark::DoNotOptimize(tree.radiusSearch(at.data(), radius * radius, found, unsorted));
    }
  say(state);
}
BENCHMARK(all_within_flann)
    ->Name("search tree, within 1 m/nanoflann")
    ->Unit(benchmark::kMillisecond);
#endif

}  // namespace
}  // namespace plumb::bench
