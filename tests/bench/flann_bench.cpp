/// Mutual matches by the indices of FLANN, beside the exact search. Per keypoint of both segments;
/// "recall" is the share of keypoints for which the index finds the nearest.

#include <algorithm>

#include "../../plugins/match/features_flann/matching.hpp"
#include "../../plugins/match/fpfh_mutual/mutual.hpp"
#include "described.hpp"

namespace plumb::bench {
namespace {

using match_features_flann::IndexKind;

void by_index(benchmark::State& state, IndexKind kind) {
  const Described& ends = Described::of(state);
  match_features_flann::IndexOptions options;
  options.kind = kind;
  for (auto _ : state)
    benchmark::DoNotOptimize(
        match_features_flann::match(ends.a.vectors, ends.b.vectors, bins, options, 0, 1));
  ends.say(state);
  const auto judged =
      match_features_flann::match(ends.a.vectors, ends.b.vectors, bins, options, 1000, 1);
  state.counters["recall"] =
      static_cast<double>(judged.exact) / static_cast<double>(std::max(judged.sampled, 1u));
}
void announce(const char* name, IndexKind kind) {
  benchmark::RegisterBenchmark(name, by_index, kind)
      ->ArgName("spacing [dm]")
      ->Arg(8)
      ->Unit(benchmark::kMillisecond);
}

void exact(benchmark::State& state) {
  const Described& ends = Described::of(state);
  for (auto _ : state)
    benchmark::DoNotOptimize(
        match_fpfh_mutual::mutual_nearest(ends.a.vectors, ends.b.vectors, bins));
  ends.say(state);
}

[[maybe_unused]] const bool announced = [] {
  announce("matches by an index/k-means", IndexKind::kmeans);
  announce("matches by an index/hierarchical", IndexKind::hierarchical);
  announce("matches by an index/exact tree", IndexKind::exact_tree);
  benchmark::RegisterBenchmark("matches by an index/match.fpfh_mutual", exact)
      ->ArgName("spacing [dm]")
      ->Arg(8)
      ->Unit(benchmark::kMillisecond);
  return true;
}();

}  // namespace
}  // namespace plumb::bench
