#include "plumb/slam/fault.hpp"

#include <cmath>
#include <cstdlib>

namespace plumb {
namespace {

constexpr const char* non_finite_pose = "a pose with a non-finite number";
constexpr const char* pose_not_rigid =
    "a pose whose rotation is none (its quaternion has not the length 1)";
constexpr const char* non_finite_point = "a point with a non-finite coordinate";
constexpr const char* non_finite_normal = "a normal with a non-finite coordinate";
constexpr const char* non_finite_information = "an information matrix with a non-finite number";
constexpr const char* columns_unlike = "a cloud whose columns are not equally long";

bool is_finite(double number) { return std::isfinite(number); }
/// The sum of all times zero: not a number as soon as one of them is none, and fast.
bool is_finite(const std::vector<float>& values) {
  float sum = 0;
  for (const float value : values) sum += value * 0.f;
  return sum == 0;
}
bool is_finite(const std::vector<Eigen::Vector3f>& points) {
  for (const auto& point : points)
    if (!point.allFinite()) return false;
  return true;
}

/// The first thing that is wrong with one of several values.
template <class T>
const char* fault_of_all(const std::vector<T>& values, const char* (*fault_of)(const T&)) {
  for (const T& value : values)
    if (const char* fault = fault_of(value); *fault) return fault;
  return "";
}

const char* fault_of_pose(const Pose& pose) {
  if (!pose.translation.allFinite() || !pose.rotation.coeffs().allFinite()) return non_finite_pose;
  constexpr double rounding = 1e-3;
  return std::abs(pose.rotation.squaredNorm() - 1) < rounding ? "" : pose_not_rigid;
}

template <class T>
bool as_long(const std::vector<T>& column, std::size_t size) {
  return column.size() == size;
}
template <class T>
bool as_long_or_empty(const std::vector<T>& column, std::size_t size) {
  return column.empty() || column.size() == size;
}

const char* fault_of_columns(const Cloud& cloud) {
  const std::size_t n = cloud.size();
  const bool places = as_long(cloud.y, n) && as_long(cloud.z, n);
  const bool measured = as_long_or_empty(cloud.intensity, n) && as_long_or_empty(cloud.time, n) &&
                        as_long_or_empty(cloud.ring, n);
  const bool normals = as_long_or_empty(cloud.nx, n) && as_long(cloud.ny, cloud.nx.size()) &&
                       as_long(cloud.nz, cloud.nx.size());
  return places && measured && normals ? "" : columns_unlike;
}

bool holds(const Box& box, const Cloud& cloud) {
  const Box least = box_of(cloud);
  return box.low.allFinite() && box.high.allFinite() &&
         (box.low.array() <= least.low.array()).all() &&
         (box.high.array() >= least.high.array()).all();
}

const char* fault_of_edge(const Edge& edge) {
  if (edge.kind > EdgeKind::loop) return "an edge of a kind that there is not";
  if (!is_finite(edge.score) || !is_finite(edge.centroid_distance))
    return "an edge with a non-finite number";
  return "";
}
const char* fault_of_relative(const RelativePose& constraint) {
  return constraint.information.allFinite() ? fault_of_pose(constraint.T_i_j)
                                            : non_finite_information;
}
const char* fault_of_absolute(const AbsolutePose& constraint) {
  return constraint.information.allFinite() ? fault_of_pose(constraint.T_world_i)
                                            : non_finite_information;
}
const char* fault_of_point(const AbsolutePoint& constraint) {
  if (!constraint.information.allFinite()) return non_finite_information;
  return constraint.p_i.allFinite() && constraint.p_world.allFinite() ? "" : non_finite_point;
}

}  // namespace

const char* fault_in(const Trajectory& trajectory) {
  if (!as_long(trajectory.T_world_frame, trajectory.stamps.size()))
    return "a trajectory of not as many stamps as poses";
  for (const double stamp : trajectory.stamps)
    if (!is_finite(stamp)) return "a non-finite stamp";
  return fault_of_all(trajectory.T_world_frame, fault_of_pose);
}

/// What a sensor gave may be no number; the steps that merge frames leave it out.
const char* fault_in(const Frame& frame) { return fault_of_columns(frame.cloud); }

const char* fault_in(const FrameRange& range) {
  if (range.end <= range.first || range.T_segment_frame.size() != range.size())
    return "a range of frames that does not have a pose for each of them";
  if (const char* fault = fault_of_pose(range.T_world_segment); *fault) return fault;
  return fault_of_all(range.T_segment_frame, fault_of_pose);
}

const char* fault_in(const Segment& segment) {
  const Cloud& cloud = segment.cloud;
  if (const char* fault = fault_in(segment.range); *fault) return fault;
  if (const char* fault = fault_of_columns(cloud); *fault) return fault;
  if (!is_finite(cloud.x) || !is_finite(cloud.y) || !is_finite(cloud.z)) return non_finite_point;
  if (!is_finite(cloud.nx) || !is_finite(cloud.ny) || !is_finite(cloud.nz))
    return non_finite_normal;
  if (!as_long(segment.frame, cloud.size()))
    return "a segment that does not name a frame for each point";
  for (const auto frame : segment.frame)
    if (frame >= segment.range.T_segment_frame.size())
      return "a point of a frame that its segment does not have";
  const bool placed = cloud.empty() || (segment.centroid.allFinite() && holds(segment.box, cloud));
  return placed ? "" : "a segment whose box or centroid is not that of its points";
}

const char* fault_in(const Descriptor& descriptor) {
  return is_finite(descriptor.values) ? "" : "a descriptor with a non-finite number";
}

const char* fault_in(const Features& features) {
  const std::size_t n = features.size();
  const bool vectors = features.vectors.size() == n * std::size_t{features.dimension};
  if (!vectors || !as_long_or_empty(features.normals, n) ||
      !as_long_or_empty(features.at_border, n))
    return "features whose columns are not equally long";
  if (!is_finite(features.points)) return non_finite_point;
  if (!is_finite(features.normals)) return non_finite_normal;
  return is_finite(features.vectors) ? "" : "a feature with a non-finite number";
}

const char* fault_in(const Edges& edges) {
  const Edge* last = nullptr;
  for (const Edge& edge : edges.list) {
    if (edge.i >= edge.j || edge.j >= edges.segments)
      return "an edge between segments that there are not, or of a segment with itself";
    if (last && std::pair(last->i, last->j) >= std::pair(edge.i, edge.j))
      return "edges that are not in order, each pair once";
    last = &edge;
  }
  return fault_of_all(edges.list, fault_of_edge);
}

const char* fault_in(const Matches& matches) {
  const std::size_t n = matches.size();
  const bool indices = as_long_or_empty(matches.index_p, n) && as_long_or_empty(matches.index_q, n);
  const bool normals =
      as_long_or_empty(matches.normal_p, n) && as_long_or_empty(matches.normal_q, n);
  if (!as_long(matches.q, n) || !indices || !normals || !as_long_or_empty(matches.weight, n) ||
      !as_long_or_empty(matches.at_border, n))
    return "matches whose columns are not equally long";
  if (!is_finite(matches.p) || !is_finite(matches.q)) return non_finite_point;
  if (!is_finite(matches.normal_p) || !is_finite(matches.normal_q)) return non_finite_normal;
  return is_finite(matches.weight) ? "" : "a non-finite weight";
}

const char* fault_in(const Registration& registration) {
  return registration.information.allFinite() ? fault_of_pose(registration.T_i_j)
                                              : non_finite_information;
}

const char* fault_in(const Constraints& constraints) {
  if (const char* fault = fault_of_all(constraints.relative, fault_of_relative); *fault)
    return fault;
  if (const char* fault = fault_of_all(constraints.absolute, fault_of_absolute); *fault)
    return fault;
  return fault_of_all(constraints.points, fault_of_point);
}

const char* fault_in(const Poses& poses) {
  return fault_of_all(poses.T_world_segment, fault_of_pose);
}

const char* fault_in(const GridMap& map) {
  if (map.log_odds.size() != std::size_t{map.columns} * map.rows)
    return "a grid of not as many cells as its columns and rows say";
  if (!is_finite(map.resolution) || !map.origin.allFinite() ||
      (!map.log_odds.empty() && map.resolution <= 0))
    return "a grid without a place or a cell size";
  return is_finite(map.log_odds) ? "" : "a cell with a non-finite number";
}

const char* fault_in(const Metrics& metrics) {
  for (const EdgeRecord& edge : metrics.edges)
    if (edge.kind > EdgeKind::loop) return "an edge of a kind that there is not";
  return "";
}

}  // namespace plumb
