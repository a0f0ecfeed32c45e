#pragma once
/// Frames and the rigid segments that they are merged into.

#include <cstdint>
#include <memory>
#include <vector>

#include "plumb/slam/cloud.hpp"
#include "plumb/slam/eigen_archive.hpp"
#include "plumb/slam/geometry/pose.hpp"
#include "plumb/slam/geometry/search_tree.hpp"

namespace plumb {

/// One scan: its place in the trajectory and a cloud in the frame's own coordinates [m].
struct Frame {
  std::uint32_t index = 0;
  Cloud cloud;
};

/// Consecutive frames that become one rigid segment. The segment's frame is that of its middle
/// frame.
struct FrameRange {
  std::uint32_t first = 0, end = 0;   ///< frames first .. end-1
  Pose T_world_segment;               ///< as the odometry has it
  std::vector<Pose> T_segment_frame;  ///< of each of its frames

  std::size_t size() const { return end - first; }
  std::size_t middle() const { return first + size() / 2; }  ///< the frame whose coordinates it has
  /// Where the sensor stood at each frame, in segment coordinates [m].
  std::vector<Eigen::Vector3f> origins() const;
};

/// A kd-tree that is built at the first question and then shared by all who hold the segment.
class LazyTree {
 public:
  const SearchTree& of(const Cloud& cloud) const;

 private:
  struct State;
  std::shared_ptr<State> state_ = make();
  static std::shared_ptr<State> make();
};

/// A merged cloud in the segment's coordinates [m].
struct Segment {
  FrameRange range;
  Cloud cloud;
  std::vector<std::uint16_t> frame;  ///< of each point: its frame's place in the range
  Eigen::Vector3f centroid = Eigen::Vector3f::Zero();
  Box box;

  /// Where the sensor stood, in segment coordinates [m], when it saw point k.
  Eigen::Vector3f origin(std::size_t k) const {
    const Eigen::Vector3d& t = range.T_segment_frame[frame[k]].translation;
    return {static_cast<float>(t.x()), static_cast<float>(t.y()), static_cast<float>(t.z())};
  }
  /// The same segment with another cloud; centroid and box follow.
  Segment with(Cloud other, std::vector<std::uint16_t> frames) const;
  /// The points with the given indices.
  Segment selected(const std::vector<std::uint32_t>& indices) const;
  /// kd-tree over the points, built once, safe from several threads.
  const SearchTree& tree() const { return tree_.of(cloud); }

 private:
  LazyTree tree_;
};

template <class Archive, class T>
requires std::is_same_v<std::remove_const_t<T>, Frame>
void fields(Archive& a, T& f) { a(f.index, f.cloud); }
template <class Archive, class T>
requires std::is_same_v<std::remove_const_t<T>, FrameRange>
void fields(Archive& a, T& r) { a(r.first, r.end, r.T_world_segment, r.T_segment_frame); }
template <class Archive, class T>
requires std::is_same_v<std::remove_const_t<T>, Segment>
void fields(Archive& a, T& s) { a(s.range, s.cloud, s.frame, s.centroid, s.box.low, s.box.high); }

}  // namespace plumb
