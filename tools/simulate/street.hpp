#pragma once
/// The streets that a path runs along, and which ground is taken: what decides where the city can
/// build.

#include <Eigen/Core>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace plumb::simulate {

/// A rectangle on the map [m], in any direction.
struct Footprint {
  Eigen::Vector2f centre;
  Eigen::Vector2f along;  ///< unit vector of its length
  Eigen::Vector2f half;   ///< half length, half width

  Eigen::Vector2f local(const Eigen::Vector2f& p) const {
    const Eigen::Vector2f d = p - centre;
    return {along.dot(d), along.x() * d.y() - along.y() * d.x()};
  }
  float distance(const Eigen::Vector2f& p) const {
    return (local(p).cwiseAbs() - half).cwiseMax(0.0f).norm();
  }
};

/// A path on the map, one node a metre, that answers how far away it is.
class Street {
 public:
  struct Node {
    Eigen::Vector2f at;
    Eigen::Vector2f along;  ///< unit vector of driving
    float z;
    bool repeated;  ///< an earlier part of the path has been here: this street is laid out
  };

  /// From positions [m] in order of driving; standing still and uneven steps do not matter.
  explicit Street(const std::vector<Eigen::Vector3f>& path);

  const std::vector<Node>& nodes() const { return nodes_; }

  /// Whether every node keeps `clearance` [m] from the rectangle.
  bool clear(const Footprint& rectangle, float clearance) const;

 private:
  std::vector<Node> nodes_;
  std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> cells_;
};

/// The rectangles that are built upon.
class Plots {
 public:
  /// Whether `rectangle` meets none of the plots by more than `tolerance` [m].
  bool free(const Footprint& rectangle, float tolerance) const;
  void take(const Footprint& rectangle);

 private:
  std::vector<Footprint> taken_;
  std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> cells_;
};

}  // namespace plumb::simulate
