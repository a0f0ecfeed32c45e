/// Planes by CGAL's region growing. Per point; "planes" is how many there are.

#include "../../plugins/segment/planes/growing.hpp"
#include "scene.hpp"

namespace plumb::bench {
namespace {

void growing(benchmark::State& state) {
  const Cloud& cloud = segment_with_normals(0);
  Segment from;
  from.range.end = 1;
  from.range.T_segment_frame.resize(1);
  const Segment segment = from.with(cloud, std::vector<std::uint16_t>(cloud.size(), 0));
  std::size_t planes = 0;
  for (auto _ : state) planes = segment_planes::grow_planes(segment, {}).planes.size();
  per(state, "point", static_cast<double>(cloud.size()));
  state.counters["planes"] = static_cast<double>(planes);
}
BENCHMARK(growing)->Name("planes/CGAL")->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace plumb::bench
