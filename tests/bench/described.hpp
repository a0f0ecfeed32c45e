#pragma once
/// Two neighbouring segments' FPFH, for benchmarks of what matches them. The argument of a
/// benchmark is the spacing of keypoints in decimetres.

#include <map>

#include "../../plugins/describe/fpfh/fpfh.hpp"
#include "plumb/plugin/testing.hpp"
#include "plumb/slam/step.hpp"
#include "scene.hpp"
#include "shared/keypoints/one_per_voxel.hpp"

namespace plumb::bench {

inline constexpr std::size_t bins = 33;

/// The features of both segments, 33 numbers a keypoint.
struct Described {
  Features a, b;

  explicit Described(double leaf) : a(described(0, leaf)), b(described(1, leaf)) {}
  static Features described(std::size_t which, double leaf) {
    const Cloud& cloud = segment_with_normals(which);
    TestContext context;
    return describe_fpfh::fpfh(cloud, keypoints::one_per_voxel(cloud, leaf), {}, context).features;
  }
  static const Described& of(const benchmark::State& state) {
    static std::map<std::int64_t, Described> all;
    const double leaf = 0.1 * static_cast<double>(state.range(0));
    return all.try_emplace(state.range(0), leaf).first->second;
  }
  void say(benchmark::State& state) const {
    per(state, "keypoint", static_cast<double>(a.size() + b.size()));
  }
};

}  // namespace plumb::bench
