/// How alike two segments are: scan contexts beside descriptors of 640 numbers. Per pair; and
/// making the context, per point.

#include "../../plugins/loops/descriptor/similarity.hpp"
#include "../../plugins/loops/scan_context/scan_context.hpp"
#include "scene.hpp"

namespace plumb::bench {
namespace {

using loops_scan_context::scan_context;

const Cloud& end(std::size_t which) { return thinned_segment(which, 0.3); }

void making(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(scan_context(end(0), segment_pose(0), {}));
  per(state, "point", static_cast<double>(end(0).size()));
}
BENCHMARK(making)->Name("scan context, making/ours")->Unit(benchmark::kMicrosecond);

void contexts(benchmark::State& state) {
  const auto a = scan_context(end(0), segment_pose(0), {}),
             b = scan_context(end(1), segment_pose(1), {});
  for (auto _ : state) benchmark::DoNotOptimize(loops_scan_context::similarity(a, b));
  per(state, "pair", 1);
  state.counters["similarity"] = loops_scan_context::similarity(a, b);
}
BENCHMARK(contexts)->Name("similarity of segments/scan context")->Unit(benchmark::kMicrosecond);

void descriptors(benchmark::State& state) {
  std::vector<float> a(640), b(640);
  for (std::size_t k = 0; k < a.size(); ++k) {
    a[k] = 1 / static_cast<float>(k + 640);
    b[k] = 1 / static_cast<float>(k + 700);
  }
  for (auto _ : state)
    benchmark::DoNotOptimize(
        loops_descriptor::similarity(a, b, loops_descriptor::Similarity::inverse_difference, 1e-4));
  per(state, "pair", 1);
}
BENCHMARK(descriptors)
    ->Name("similarity of segments/loops.descriptor")
    ->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace plumb::bench
