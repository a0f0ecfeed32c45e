/// Mutual nearest neighbours of two neighbouring segments' FPFH (33-D), beside FLANN's exact tree
/// and comparing all pairs.

#include <benchmark/benchmark.h>

#include "../../plugins/describe/fpfh/fpfh.hpp"
#include "../../plugins/describe/fpfh/key_points.hpp"
#include "../../plugins/match/fpfh_mutual/mutual.hpp"
#include "plumb/plugin/testing.hpp"
#include "scene.hpp"
#ifdef PLUMB_HAS_FLANN
#include <flann/flann.hpp>
#endif

namespace plumb::bench {
namespace {

/// Two neighbouring segments, described at about as many points as the argument says.
struct Ends {
  std::vector<float> a, b;
  explicit Ends(double leaf) : a(described(0, leaf)), b(described(1, leaf)) {}
  static std::vector<float> described(unsigned which, double leaf) {
    const Cloud cloud = street_segment_with_normals(which);
    TestContext context;
    return fpfh(cloud, key_points(cloud, leaf), {}, context).features.vectors;
  }
  static const Ends& at(std::int64_t decimetres) {
    static std::map<std::int64_t, Ends> all;
    return all.try_emplace(decimetres, 0.1 * static_cast<double>(decimetres)).first->second;
  }
};

void say(benchmark::State& state) {
  const Ends& ends = Ends::at(state.range(0));
  state.SetLabel(scene_name() + ", key points per " + std::to_string(state.range(0)) + " dm");
  state.counters["a"] = static_cast<double>(ends.a.size() / 33);
  state.counters["b"] = static_cast<double>(ends.b.size() / 33);
  state.counters["time/point"] = benchmark::Counter(
      static_cast<double>((ends.a.size() + ends.b.size()) / 33),
      benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void Mutual_ours(benchmark::State& state) {
  const Ends& ends = Ends::at(state.range(0));
  for (auto _ : state) benchmark::DoNotOptimize(mutual_nearest(ends.a, ends.b, 33));
  say(state);
}
BENCHMARK(Mutual_ours)->Arg(8)->Arg(12)->Unit(benchmark::kMillisecond);

void Mutual_all_pairs(benchmark::State& state) {
  const Ends& ends = Ends::at(state.range(0));
  for (auto _ : state) benchmark::DoNotOptimize(mutual_nearest_plainly(ends.a, ends.b, 33));
  say(state);
}
BENCHMARK(Mutual_all_pairs)->Arg(8)->Arg(12)->Unit(benchmark::kMillisecond)->Iterations(1);

#ifdef PLUMB_HAS_FLANN
void Mutual_flann_exact(benchmark::State& state) {
  const Ends& ends = Ends::at(state.range(0));
  const auto matrix = [](const std::vector<float>& v) {
    return flann::Matrix<float>(const_cast<float*>(v.data()), v.size() / 33, 33);
  };
  const auto nearest = [&](const std::vector<float>& of, const std::vector<float>& among) {
    flann::Index<flann::L2<float>> index(matrix(among), flann::KDTreeSingleIndexParams(10));
    index.buildIndex();
    std::vector<std::vector<int>> found;
    std::vector<std::vector<float>> distances;
    index.knnSearch(matrix(of), found, distances, 1,
                    flann::SearchParams(flann::FLANN_CHECKS_UNLIMITED));
    return found;
  };
  for (auto _ : state) {
    benchmark::DoNotOptimize(nearest(ends.a, ends.b));
    benchmark::DoNotOptimize(nearest(ends.b, ends.a));
  }
  say(state);
}
BENCHMARK(Mutual_flann_exact)->Arg(8)->Arg(12)->Unit(benchmark::kMillisecond);
#endif

}  // namespace
}  // namespace plumb::bench
