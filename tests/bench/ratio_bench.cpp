/// Matches that are nearest by far, tested both ways, beside the mutual nearest ones. Per keypoint
/// of both segments.

#include "../../plugins/match/fpfh_mutual/mutual.hpp"
#include "../../plugins/match/fpfh_ratio/ratio.hpp"
#include "described.hpp"

namespace plumb::bench {
namespace {

void ours(benchmark::State& state) {
  const Described& ends = Described::of(state);
  std::size_t pairs = 0;
  for (auto _ : state) pairs = match_fpfh_ratio::distinctive_pairs(ends.a, ends.b, {}).size();
  ends.say(state);
  state.counters["pairs"] = static_cast<double>(pairs);
}
BENCHMARK(ours)
    ->Name("ratio test/ours")
    ->ArgName("spacing [dm]")
    ->Arg(8)
    ->Unit(benchmark::kMillisecond);

void mutual(benchmark::State& state) {
  const Described& ends = Described::of(state);
  std::size_t pairs = 0;
  for (auto _ : state)
    pairs = match_fpfh_mutual::mutual_nearest(ends.a.vectors, ends.b.vectors, bins).size();
  ends.say(state);
  state.counters["pairs"] = static_cast<double>(pairs);
}
BENCHMARK(mutual)
    ->Name("ratio test/match.fpfh_mutual")
    ->ArgName("spacing [dm]")
    ->Arg(8)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace plumb::bench
