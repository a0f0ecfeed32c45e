#include "shared/pcl/registering.hpp"

#include <algorithm>
#include <cmath>

namespace plumb::pcl {
namespace {

/// Sums over the pairs, as they come.
class Sums {
 public:
  explicit Sums(const Pose& T_i_j) : turn_(T_i_j.matrix()) {}

  /// p in i's, q in j's coordinates; `off` is T_i_j q - p. A normal of 0: all directions count.
  void add(const Eigen::Vector3d& off, const Eigen::Vector3d& q, const Eigen::Vector3d& normal) {
    ++pairs_;
    distances_ += off.norm();
    if (!normal.isZero()) return add_along(normal, off, q);
    for (int c = 0; c < 3; ++c) add_along(Eigen::Vector3d::Unit(c), off, q);
  }

  std::uint32_t pairs() const { return pairs_; }
  double mean_distance() const { return pairs_ > 0 ? distances_ / pairs_ : 0; }
  Matrix6d information(double independent) const {
    if (pairs_ == 0) return Matrix6d::Zero();
    const double noise = std::max(squares_ / directions_, 1e-4);
    return information_ * (std::min<double>(independent, pairs_) / pairs_ / noise);
  }

 private:
  void add_along(const Eigen::Vector3d& direction, const Eigen::Vector3d& off,
                 const Eigen::Vector3d& q) {
    const Eigen::Vector3d in_j = turn_.transpose() * direction;
    Vector6d row;
    row << in_j, q.cross(in_j);
    information_ += row * row.transpose();
    squares_ += std::pow(direction.dot(off), 2);
    directions_ += 1;
  }

  Eigen::Matrix3d turn_;
  Matrix6d information_ = Matrix6d::Zero();
  double distances_ = 0, squares_ = 0, directions_ = 0;
  std::uint32_t pairs_ = 0;
};

/// What of a motion stays in the plane z = 0.
Pose flattened(const Pose& pose) {
  const Eigen::Matrix3d r = pose.matrix();
  return {exp_rotation({0, 0, std::atan2(r(1, 0), r(0, 0))}),
          {pose.translation.x(), pose.translation.y(), 0}};
}

void flatten(Matrix6d& information) {
  for (const int c : {2, 3, 4}) {
    information.row(c).setZero();
    information.col(c).setZero();
  }
}

}  // namespace

Eigen::Matrix4f matrix_of(const Pose& pose) {
  Eigen::Matrix4f matrix = Eigen::Matrix4f::Identity();
  matrix.topLeftCorner<3, 3>() = pose.matrix().cast<float>();
  matrix.topRightCorner<3, 1>() = pose.translation.cast<float>();
  return matrix;
}

Aligned aligned_by(const Eigen::Matrix4f& matrix, int iterations, bool converged) {
  const Eigen::Matrix3d r = matrix.topLeftCorner<3, 3>().cast<double>();
  const auto count = static_cast<std::uint32_t>(std::max(iterations, 0));
  if (!matrix.allFinite() || !(std::abs(r.determinant() - 1) < 1e-2)) return {Pose(), count, false};
  return {Pose(r, matrix.topRightCorner<3, 1>().cast<double>()), count, converged};
}

Registration judged(const Segment& i, const Cloud& j, const Aligned& found, const Pose& start,
                    const FitOptions& options) {
  Registration result;
  result.iterations = found.iterations;
  result.T_i_j = found.converged ? found.T_i_j : start;
  if (options.planar) result.T_i_j = flattened(result.T_i_j);
  if (i.cloud.empty() || j.empty()) return result;
  const SearchTree& tree = i.tree();
  const auto max = static_cast<float>(options.max_correspondence_distance);
  Sums sums(result.T_i_j);
  for (std::size_t k = 0; k < j.size(); ++k) {
    const Eigen::Vector3d q = j.point(k).cast<double>();
    const Eigen::Vector3d moved = result.T_i_j * q;
    SearchTree::Neighbour nearest;
    if (!tree.nearest_within(moved.cast<float>(), max, nearest)) continue;
    const Eigen::Vector3d normal = i.cloud.has_normals()
                                       ? i.cloud.normal(nearest.index).cast<double>().eval()
                                       : Eigen::Vector3d::Zero().eval();
    sums.add(moved - i.cloud.point(nearest.index).cast<double>(), q, normal);
  }
  result.pairs = sums.pairs();
  result.mae = static_cast<float>(sums.mean_distance());
  result.overlap = static_cast<float>(sums.pairs()) / static_cast<float>(j.size());
  result.information = sums.information(options.independent);
  if (options.planar) flatten(result.information);
  result.accepted = found.converged && result.pairs >= 3 && result.overlap >= options.min_overlap &&
                    !result.information.isZero(0);
  return result;
}

}  // namespace plumb::pcl
