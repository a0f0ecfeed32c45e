/// ESF of a segment beside PCL's ESFEstimation.

#include <benchmark/benchmark.h>

#include "../../plugins/describe/esf/esf.hpp"
#include "scene.hpp"
#ifdef PLUMB_HAS_PCL
#include "pcl_twins.hpp"
#endif

namespace plumb::bench {
namespace {

const Cloud& scene() {
  static const Cloud cloud = street_segment(0);
  return cloud;
}

void say(benchmark::State& state) {
  state.SetLabel(scene_name());
  state.counters["points"] = static_cast<double>(scene().size());
  state.counters["time/triple"] = benchmark::Counter(
      20000, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void Esf_ours(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(esf(scene(), 20000, 1));
  say(state);
}
BENCHMARK(Esf_ours)->Unit(benchmark::kMillisecond);

#ifdef PLUMB_HAS_PCL
void Esf_pcl(benchmark::State& state) {
  const Cloud& c = scene();
  const twins::PclCloud twin(c.x, c.y, c.z, {}, {}, {});
  for (auto _ : state) benchmark::DoNotOptimize(twin.esf());
  say(state);
}
BENCHMARK(Esf_pcl)->Unit(benchmark::kMillisecond);
#endif

}  // namespace
}  // namespace plumb::bench
