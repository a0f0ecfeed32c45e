#pragma once
/// Which cells of a 64^3 grid a cloud fills, in 32 kB.

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

namespace plumb::describe_esf {

/// A straight line of cells: how many there are, and how many of them are solid.
struct Line {
  int cells, solid;
};

class SolidGrid {
 public:
  static constexpr int side = 64;

  /// Points within 32 cells of the origin. Their cells and all that touch these are solid.
  explicit SolidGrid(const std::vector<Eigen::Vector3f>& points);

  /// The cell of a point: coordinate 0 lies between cells 31 and 32.
  static Eigen::Vector3i cell_of(const Eigen::Vector3f& point);

  bool solid(const Eigen::Vector3i& cell) const {
    return bits_[static_cast<std::size_t>(cell.x() * side + cell.y())] >> cell.z() & 1;
  }

  /// Follows the line from cell `from` towards `to` by Bresenham's rule along the longest axis,
  /// `to` itself left out (but at least one cell).
  Line trace(const Eigen::Vector3i& from, const Eigen::Vector3i& to) const;

 private:
  std::array<std::uint64_t, side * side> bits_{};
};

}  // namespace plumb::describe_esf
