/// Keeping the pairs that agree: K-means beside RANSAC, beside compatible pairs and beside steps
/// that call PCL, per pair of an edge with 400 pairs. The argument is the share of right pairs in
/// percent. "right" is the share in what is kept.

#include <algorithm>

#include "../../plugins/prune/consistency/consistency.hpp"
#include "../../plugins/prune/kmeans/kmeans.hpp"
#include "../../plugins/prune/kmeans/motion_vectors.hpp"
#include "../../plugins/prune/ransac/ransac.hpp"
#include "scene.hpp"
#ifdef PLUMB_HAS_PCL
#include "pcl_steps.hpp"
#endif

namespace plumb::bench {
namespace {

constexpr std::uint32_t pairs = 400;

std::uint32_t right(const benchmark::State& state) {
  return pairs * static_cast<std::uint32_t>(state.range(0)) / 100;
}

/// Pairs in a box of 60 m, the first ones 0.2 m about a motion of 1.5 m, the rest up to 5 m from
/// it.
Matches planted(const benchmark::State& state) {
  Random random(7);
  const auto in_box = [&](float half) {
    Eigen::Vector3f v;
    for (int c = 0; c < 3; ++c) v[c] = half * static_cast<float>(2 * random.uniform() - 1);
    return v;
  };
  const Motion drift(Pose(exp_rotation({0, 0, 0.01}), {1.4, -0.5, 0.1}));
  Matches matches;
  for (std::uint32_t k = 0; k < pairs; ++k) {
    matches.q.push_back(in_box(30));
    matches.p.push_back(drift * matches.q.back() + in_box(k < right(state) ? 0.2f : 5.0f));
    matches.index_p.push_back(k), matches.index_q.push_back(k / 2);  // two pairs a point of j
  }
  return matches;
}

void say(benchmark::State& state, const std::vector<std::uint32_t>& kept) {
  per(state, "pair", pairs);
  const auto good = std::ranges::count_if(kept, [&](auto k) { return k < right(state); });
  state.counters["kept"] = static_cast<double>(kept.size());
  state.counters["right"] =
      static_cast<double>(good) / static_cast<double>(std::max<std::size_t>(kept.size(), 1));
}

void by_kmeans(benchmark::State& state) {
  const Matches matches = planted(state);
  std::vector<std::uint32_t> kept;
  for (auto _ : state) {
    const auto vectors = prune_kmeans::displacements(matches, Pose());
    kept = prune_kmeans::best_cluster(prune_kmeans::kmeans(vectors, 30, Random(1)), vectors,
                                      prune_kmeans::Keep::largest, 0.1, 6);
  }
  say(state, kept);
}
BENCHMARK(by_kmeans)
    ->Name("prune/K-means")
    ->ArgName("right [%]")
    ->Arg(40)
    ->Arg(15)
    ->Arg(5)
    ->Unit(benchmark::kMicrosecond);

void by_ransac(benchmark::State& state) {
  const Matches matches = planted(state);
  std::vector<std::uint32_t> kept;
  for (auto _ : state) kept = prune_ransac::ransac(matches, {}, Random(1)).inliers;
  say(state, kept);
}
BENCHMARK(by_ransac)
    ->Name("prune/RANSAC")
    ->ArgName("right [%]")
    ->Arg(40)
    ->Arg(15)
    ->Arg(5)
    ->Unit(benchmark::kMicrosecond);

void by_consistency(benchmark::State& state) {
  const Matches matches = planted(state);
  std::vector<std::uint32_t> kept;
  for (auto _ : state) kept = prune_consistency::consistent_pairs(matches, {}).inliers;
  say(state, kept);
}
BENCHMARK(by_consistency)
    ->Name("prune/consistency")
    ->ArgName("right [%]")
    ->Arg(40)
    ->Arg(15)
    ->Arg(5)
    ->Unit(benchmark::kMicrosecond);

#ifdef PLUMB_HAS_PCL
template <std::vector<std::uint32_t> (*Keep)(const Matches&)>
void by_pcl(benchmark::State& state) {
  const Matches matches = planted(state);
  std::vector<std::uint32_t> kept;
  for (auto _ : state) kept = Keep(matches);
  say(state, kept);
}
BENCHMARK(by_pcl<twins::geometric_consistency>)
    ->Name("prune/geometric_consistency")
    ->ArgName("right [%]")
    ->Arg(40)
    ->Arg(15)
    ->Arg(5)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK(by_pcl<twins::hough>)
    ->Name("prune/hough")
    ->ArgName("right [%]")
    ->Arg(40)
    ->Arg(15)
    ->Arg(5)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK(by_pcl<twins::one_to_one>)
    ->Name("prune/one_to_one")
    ->ArgName("right [%]")
    ->Arg(40)
    ->Arg(15)
    ->Arg(5)
    ->Unit(benchmark::kMicrosecond);
#endif

}  // namespace
}  // namespace plumb::bench
