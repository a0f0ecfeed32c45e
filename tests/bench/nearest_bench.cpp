/// Pairing two neighbouring segments by nearest points within 0.5 m, the tree being there, beside
/// PCL's KdTreeFLANN. Per point of the first segment.

#include "../../plugins/match/nearest/nearest.hpp"
#include "scene.hpp"
#ifdef PLUMB_HAS_PCL
#include "pcl_space.hpp"
#endif

namespace plumb::bench {
namespace {

constexpr double max = 0.5, leaf = 0.3;

Pose relative() { return segment_pose(0).inverse() * segment_pose(1); }  // T_i_j

void say(benchmark::State& state, std::size_t pairs) {
  per(state, "point", static_cast<double>(thinned_segment(0, leaf).size()));
  state.counters["pairs"] = static_cast<double>(pairs);
}

void ours(benchmark::State& state) {
  const auto segment = [](std::size_t which) {
    const Cloud& cloud = thinned_segment(which, leaf);
    return Segment().with(cloud, std::vector<std::uint16_t>(cloud.size(), 0));
  };
  const Segment i = segment(0), j = segment(1);
  j.tree();
  match_nearest::NearestOptions options;
  options.max_correspondence_distance = max;
  std::size_t pairs = 0;
  for (auto _ : state) pairs = match_nearest::nearest_pairs(i, j, relative(), options).size();
  say(state, pairs);
}
BENCHMARK(ours)->Name("nearest/ours")->Unit(benchmark::kMillisecond);

#ifdef PLUMB_HAS_PCL
void pcl(benchmark::State& state) {
  const Cloud& i = thinned_segment(0, leaf);
  const Cloud& j = thinned_segment(1, leaf);
  Cloud moved;
  const Motion T_j_i(relative().inverse());
  for (std::size_t k = 0; k < i.size(); ++k) moved.add(T_j_i * i.point(k));
  const twins::PclSpace asking(moved.x, moved.y, moved.z);
  twins::PclSpace asked(j.x, j.y, j.z);
  asked.build_tree();
  std::size_t pairs = 0;
  for (auto _ : state) pairs = asked.near_to(asking, static_cast<float>(max));
  say(state, pairs);
}
BENCHMARK(pcl)->Name("nearest/PCL")->Unit(benchmark::kMillisecond);
#endif

}  // namespace
}  // namespace plumb::bench
