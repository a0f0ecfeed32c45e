/// Steps that call PCL beside ours that answer the same question: keypoints, descriptors of
/// keypoints and of segments, outliers, samples of points, registration. What has a tree builds it.

#include "../../plugins/describe/esf/esf.hpp"
#include "../../plugins/describe/fpfh/fpfh.hpp"
#include "../../plugins/filter/statistical_outlier/statistical_outlier.hpp"
#include "../../plugins/register/features/refine.hpp"
#include "pcl_steps.hpp"
#include "plumb/plugin/testing.hpp"
#include "plumb/slam/step.hpp"
#include "scene.hpp"
#include "shared/keypoints/one_per_voxel.hpp"
#include "shared/parallel/loop_testing.hpp"

namespace plumb::bench {
namespace {

constexpr double spacing = 0.8;  // of keypoints [m]

/// Announces "KERNEL/WHO": `what` is called with the cloud and gives what it found.
template <class What>
void add(const char* name, const char* each, double leaf, What what) {
  benchmark::RegisterBenchmark(name, [=](benchmark::State& state) {
    const Cloud& cloud = leaf == 0.3 ? segment_with_normals(0) : thinned_segment(0, leaf);
    std::size_t found = 0;
    for (auto _ : state) found = what(cloud);
    per(state, each, static_cast<double>(cloud.size()));
    state.counters["found"] = static_cast<double>(found);
  })->Unit(benchmark::kMillisecond);
}

std::vector<std::uint32_t> keys_of(const Cloud& cloud) {
  return keypoints::one_per_voxel(cloud, spacing);
}

std::size_t fpfh(const Cloud& cloud) {
  TestContext one_thread;
  return describe_fpfh::fpfh(cloud, keys_of(cloud), {}, one_thread).features.vectors.size();
}

std::size_t statistical_outlier(const Cloud& cloud) {
  const auto distances =
      filter_statistical_outlier::mean_distances(cloud, SearchTree(cloud), 20, parallel::in_order);
  return filter_statistical_outlier::not_beyond(distances, 2).size();
}

std::size_t esf(const Cloud& cloud) {
  const auto vector = describe_esf::esf(cloud, 20000, 1);
  return vector ? vector->size() : 0;
}

/// Segment 1 in the coordinates of segment 0, 0.3 m off.
Pose start() {
  Pose T_i_j = segment_pose(0).inverse() * segment_pose(1);
  T_i_j.translation.x() += 0.3;
  return T_i_j;
}

std::size_t icp(const Cloud& cloud) {
  const auto segment = [](const Cloud& of) {
    Segment made;
    made.range.end = 1;
    made.range.T_segment_frame.resize(1);
    return made.with(of, std::vector<std::uint16_t>(of.size(), 0));
  };
  return register_features::refined(segment(cloud), segment(segment_with_normals(1)),
                                    start().inverse(), {})
      .iterations;
}

[[maybe_unused]] const bool announced = [] {
  add("keypoints/one a voxel", "point", 0.3, [](const Cloud& c) { return keys_of(c).size(); });
  add("keypoints/keypoints.iss", "point", 0.3, twins::iss);
  add("keypoints/keypoints.harris3d", "point", 0.3, twins::harris3d);
  add("keypoint descriptors/describe.fpfh", "point", 0.3, fpfh);
  add("keypoint descriptors/describe.shot", "point", 0.3,
      [](const Cloud& c) { return twins::shot(c, keys_of(c)); });
  add("segment descriptor/describe.esf", "point", 0.3, esf);
  add("segment descriptor/describe.vfh", "point", 0.3, twins::vfh);
  add("segment descriptor/describe.gasd", "point", 0.3, twins::gasd);
  add("outliers/filter.statistical_outlier", "point", 0.1, statistical_outlier);
  add("outliers/filter.radius_outlier", "point", 0.1,
      [](const Cloud& c) { return twins::radius_outlier(c, 1, 4); });
  add("sample of 30 %/filter.covariance_sampling", "point", 0.3,
      [](const Cloud& c) { return twins::covariance_sampling(c, 3 * c.size() / 10); });
  add("sample of 30 %/filter.normal_space", "point", 0.3,
      [](const Cloud& c) { return twins::normal_space(c, 3 * c.size() / 10); });
  add("registration/ICP of register.features", "point", 0.3, icp);
  add("registration/register.gicp", "point", 0.3, [](const Cloud& c) -> std::size_t {
    return twins::gicp(c, segment_with_normals(1), start());
  });
  add("registration/register.ndt", "point", 0.3, [](const Cloud& c) -> std::size_t {
    return twins::ndt(c, segment_with_normals(1), start());
  });
  return true;
}();

}  // namespace
}  // namespace plumb::bench
