#pragma once
/// What joins segments: edges, point matches, constraints; and where segments are.

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "plumb/slam/eigen_archive.hpp"
#include "plumb/slam/geometry/pose.hpp"

namespace plumb {

enum class EdgeKind : std::uint8_t { sequential, neighbour, loop };
const char* name_of(EdgeKind kind);

/// A pair of segments, i < j, that should fit together.
struct Edge {
  std::uint32_t i = 0, j = 0;
  EdgeKind kind = EdgeKind::sequential;
  float score = 0;              ///< overlap or similarity, 0 to 1; 1 for sequential
  float centroid_distance = 0;  ///< [m] between the clouds' centroids when the edge was proposed
};

/// All edges of one graph, ordered by (i, j), each pair once.
struct Edges {
  std::uint32_t segments = 0;  ///< how many segments there are
  std::vector<Edge> list;

  std::size_t size() const { return list.size(); }
};

/// Point pairs of one edge: p in segment i's and q in segment j's coordinates [m], so that T_i p
/// should be T_j q.
struct Matches {
  std::vector<Eigen::Vector3f> p, q;
  std::vector<std::uint32_t> index_p, index_q;  ///< keypoints (features) or cloud points (nearest)
  std::vector<float> weight;
  std::vector<std::uint8_t> at_border;    ///< 1 where p or q lies at its cloud's border
  std::vector<Eigen::Vector3f> normal_p;  ///< unit normals in i's coordinates; empty where unknown
  std::vector<Eigen::Vector3f> normal_q;  ///< unit normals in j's coordinates; empty where unknown
  std::uint32_t found = 0;                ///< pairs before any pruning
  bool to_plane =
      false;  ///< the residual is normal_q' (T_j^-1 T_i p - q) instead of the whole difference

  std::size_t size() const { return p.size(); }
};

/// The pairs with the given indices; `found` and `to_plane` stay.
Matches select(const Matches& matches, const std::vector<std::uint32_t>& indices);

/// Where each segment is: world_T_segment.
struct Poses {
  std::vector<Pose> T_world_segment;

  std::size_t size() const { return T_world_segment.size(); }
  /// T_i_j: maps segment j's coordinates to segment i's.
  Pose relative(std::size_t i, std::size_t j) const {
    return T_world_segment[i].inverse() * T_world_segment[j];
  }
};

/// Throws Error unless the poses are those of so many segments.
void require_pose_each(const Poses& poses, std::size_t segments);

/// A measured relative pose between two vertices with its information matrix (translation first,
/// then rotation).
struct RelativePose {
  std::uint32_t i = 0, j = 0;
  Pose T_i_j;
  Matrix6d information = Matrix6d::Identity();
};
/// A measured absolute pose of a vertex.
struct AbsolutePose {
  std::uint32_t i = 0;
  Pose T_world_i;
  Matrix6d information = Matrix6d::Identity();
};
/// A measured position of a vertex-fixed point: T_world_i * p_i should be p_world.
struct AbsolutePoint {
  std::uint32_t i = 0;
  Eigen::Vector3d p_i = Eigen::Vector3d::Zero(), p_world = Eigen::Vector3d::Zero();
  Eigen::Matrix3d information = Eigen::Matrix3d::Identity();
};

/// Constraints that do not come from point matches: g2o files, control points, GNSS.
struct Constraints {
  bool planar = false;             ///< from SE(2): z, roll and pitch are not observed and stay 0
  std::vector<std::uint64_t> ids;  ///< the file's vertex numbers, by our index
  std::vector<RelativePose> relative;
  std::vector<AbsolutePose> absolute;
  std::vector<AbsolutePoint> points;
};

template <class Archive, class T>
requires std::is_same_v<std::remove_const_t<T>, Edge>
void fields(Archive& a, T& e) { a(e.i, e.j, e.kind, e.score, e.centroid_distance); }
template <class Archive, class T>
requires std::is_same_v<std::remove_const_t<T>, Edges>
void fields(Archive& a, T& e) { a(e.segments, e.list); }
template <class Archive, class T>
requires std::is_same_v<std::remove_const_t<T>, Matches>
void fields(Archive& a, T& m) {
  a(m.p, m.q, m.index_p, m.index_q, m.weight, m.at_border, m.normal_p, m.normal_q, m.found,
    m.to_plane);
}
template <class Archive, class T>
requires std::is_same_v<std::remove_const_t<T>, Poses>
void fields(Archive& a, T& p) { a(p.T_world_segment); }
template <class Archive, class T>
requires std::is_same_v<std::remove_const_t<T>, RelativePose>
void fields(Archive& a, T& r) { a(r.i, r.j, r.T_i_j, r.information); }
template <class Archive, class T>
requires std::is_same_v<std::remove_const_t<T>, AbsolutePose>
void fields(Archive& a, T& r) { a(r.i, r.T_world_i, r.information); }
template <class Archive, class T>
requires std::is_same_v<std::remove_const_t<T>, AbsolutePoint>
void fields(Archive& a, T& r) { a(r.i, r.p_i, r.p_world, r.information); }
template <class Archive, class T>
requires std::is_same_v<std::remove_const_t<T>, Constraints>
void fields(Archive& a, T& r) { a(r.planar, r.ids, r.relative, r.absolute, r.points); }

}  // namespace plumb
