/// Mutual nearest neighbours of two neighbouring segments' FPFH (33-D), beside comparing all pairs
/// and beside FLANN's exact tree. The argument is the spacing of keypoints in decimetres.

#include <map>

#include "../../plugins/describe/fpfh/fpfh.hpp"
#include "../../plugins/match/fpfh_mutual/mutual.hpp"
#include "plumb/plugin/testing.hpp"
#include "plumb/slam/step.hpp"
#include "scene.hpp"
#include "shared/keypoints/one_per_voxel.hpp"
#ifdef PLUMB_HAS_FLANN
#include <flann/flann.hpp>
#endif

namespace plumb::bench {
namespace {

constexpr std::size_t bins = 33;

/// The features of both segments, 33 numbers a keypoint.
struct Ends {
  std::vector<float> a, b;

  explicit Ends(double leaf) : a(described(0, leaf)), b(described(1, leaf)) {}
  static std::vector<float> described(std::size_t which, double leaf) {
    const Cloud& cloud = segment_with_normals(which);
    TestContext context;
    return describe_fpfh::fpfh(cloud, keypoints::one_per_voxel(cloud, leaf), {}, context)
        .features.vectors;
  }
  static const Ends& of(const benchmark::State& state) {
    static std::map<std::int64_t, Ends> all;
    const double leaf = 0.1 * static_cast<double>(state.range(0));
    return all.try_emplace(state.range(0), leaf).first->second;
  }
  void say(benchmark::State& state) const {
    per(state, "keypoint", static_cast<double>((a.size() + b.size()) / bins));
  }
};

void ours(benchmark::State& state) {
  const Ends& ends = Ends::of(state);
  for (auto _ : state)
    benchmark::DoNotOptimize(match_fpfh_mutual::mutual_nearest(ends.a, ends.b, bins));
  ends.say(state);
}
BENCHMARK(ours)
    ->Name("mutual/ours")
    ->ArgName("spacing [dm]")
    ->Arg(8)
    ->Arg(12)
    ->Unit(benchmark::kMillisecond);

void all_pairs(benchmark::State& state) {
  const Ends& ends = Ends::of(state);
  for (auto _ : state)
    benchmark::DoNotOptimize(match_fpfh_mutual::mutual_nearest_plainly(ends.a, ends.b, bins));
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
  const Ends& ends = Ends::of(state);
  for (auto _ : state) {
    benchmark::DoNotOptimize(nearest(ends.a, ends.b));
    benchmark::DoNotOptimize(nearest(ends.b, ends.a));
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
