/// ESF of a segment from 20,000 triples of points, beside PCL's ESFEstimation (which draws as
/// many).

#include "../../plugins/describe/esf/esf.hpp"
#include "scene.hpp"
#ifdef PLUMB_HAS_PCL
#include "pcl_twins.hpp"
#endif

namespace plumb::bench {
namespace {

constexpr std::uint32_t triples = 20000;

void ours(benchmark::State& state) {
  const Cloud& cloud = thinned_segment(0, 0.3);
  for (auto _ : state) benchmark::DoNotOptimize(describe_esf::esf(cloud, triples, 1));
  per(state, "triple", triples);
}
BENCHMARK(ours)->Name("esf/ours")->Unit(benchmark::kMillisecond);

#ifdef PLUMB_HAS_PCL
void pcl(benchmark::State& state) {
  const Cloud& cloud = thinned_segment(0, 0.3);
  const twins::PclCloud twin(cloud.x, cloud.y, cloud.z, {}, {}, {});
  for (auto _ : state) benchmark::DoNotOptimize(twin.esf());
  per(state, "triple", triples);
}
BENCHMARK(pcl)->Name("esf/PCL")->Unit(benchmark::kMillisecond);
#endif

}  // namespace
}  // namespace plumb::bench
