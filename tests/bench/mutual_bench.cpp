/// Mutual nearest neighbours of two neighbouring segments' FPFH (33-D), beside comparing all pairs
/// and beside FLANN's exact tree. The argument is the spacing of keypoints in decimetres.

#include "../../plugins/match/fpfh_mutual/mutual.hpp"
#include "described.hpp"
#ifdef PLUMB_HAS_FLANN
#include <flann/flann.hpp>
#endif

namespace plumb::bench {
namespace {

void ours(benchmark::State& state) {
  const Described& ends = Described::of(state);
  for (auto _ : state)
    benchmark::DoNotOptimize(
        match_fpfh_mutual::mutual_nearest(ends.a.vectors, ends.b.vectors, bins));
  ends.say(state);
}
BENCHMARK(ours)
    ->Name("mutual/ours")
    ->ArgName("spacing [dm]")
    ->Arg(8)
    ->Arg(12)
    ->Unit(benchmark::kMillisecond);

void all_pairs(benchmark::State& state) {
  const Described& ends = Described::of(state);
  for (auto _ : state)
    benchmark::DoNotOptimize(
        match_fpfh_mutual::mutual_nearest_plainly(ends.a.vectors, ends.b.vectors, bins));
  ends.say(state);
}
BENCHMARK(all_pairs)
    ->Name("mutual/all pairs")
    ->ArgName("spacing [dm]")
    ->Arg(8)
    ->Arg(12)
    ->Unit(benchmark::kMillisecond);

#ifdef PLUMB_HAS_FLANN
std::vector<std::vector<int>> nearest(const std::vector<float>& of,
                                      const std::vector<float>& among) {
  const auto matrix = [](const std::vector<float>& v) {
    return flann::Matrix<float>(const_cast<float*>(v.data()), v.size() / bins, bins);
  };
  flann::Index<flann::L2<float>> index(matrix(among), flann::KDTreeSingleIndexParams(10));
  index.buildIndex();
  std::vector<std::vector<int>> found;
  std::vector<std::vector<float>> distances;
  const flann::SearchParams exact(flann::FLANN_CHECKS_UNLIMITED);
  index.knnSearch(matrix(of), found, distances, 1, exact);
  return found;
}

void exact_tree(benchmark::State& state) {
  const Described& ends = Described::of(state);
  for (auto _ : state) {
    benchmark::DoNotOptimize(nearest(ends.a.vectors, ends.b.vectors));
    benchmark::DoNotOptimize(nearest(ends.b.vectors, ends.a.vectors));
  }
  ends.say(state);
}
BENCHMARK(exact_tree)
    ->Name("mutual/FLANN")
    ->ArgName("spacing [dm]")
    ->Arg(8)
    ->Arg(12)
    ->Unit(benchmark::kMillisecond);
#endif

}  // namespace
}  // namespace plumb::bench
