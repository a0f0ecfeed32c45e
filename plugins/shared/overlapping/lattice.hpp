#pragma once
/// Cubic cells that all clouds share, so that what overlaps does not depend on who is asked.

#include <Eigen/Geometry>
#include <vector>

#include "plumb/slam/segment.hpp"

namespace plumb::overlapping {

inline constexpr int most_bits = 21;  ///< three such numbers fit 64 bits

/// Cubic voxels of edge `size` [m] in world coordinates: voxel (0, 0, 0) begins at `origin` [m], a
/// whole multiple of `size`.
struct Lattice {
  double size = 1;
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  int bits = most_bits;  ///< the cells that matter are 0 .. 2^bits - 1 along each axis
};

/// The smallest world box [m] round `box`, which is in the segment's coordinates; in double, for
/// world coordinates can be large.
Eigen::AlignedBox3d world_box(const Box& box, const Pose& T_world_segment);

/// The lattice that holds all `boxes`, with cells to spare on all sides. Throws Error when that
/// takes more than 2^21 voxels along an axis.
Lattice lattice_over(const std::vector<Eigen::AlignedBox3d>& boxes, double size);

/// Where the points of a segment lie in a lattice.
class Cells {
 public:
  Cells(const Pose& T_world_segment, const Lattice& lattice)
      : r_(T_world_segment.matrix() / lattice.size),
        t_((T_world_segment.translation - lattice.origin) / lattice.size) {}
  /// From the lattice's origin [edges of a cell]; the whole parts name the cell.
  Eigen::Vector3d of(const Eigen::Vector3f& point) const { return r_ * point.cast<double>() + t_; }
  /// Whether they are numbers, of a cell that has a name of `bits` bits an axis.
  static bool within(const Eigen::Vector3d& cell, int bits) {
    return cell.minCoeff() >= 0 && cell.maxCoeff() < 1 << bits;
  }

 private:
  Eigen::Matrix3d r_;
  Eigen::Vector3d t_;
};

}  // namespace plumb::overlapping
