#pragma once
/// How uncertain each pose is, beside the fixed ones.

#include <Eigen/SparseCore>
#include <optional>
#include <span>
#include <vector>

#include "pose_manifold.hpp"

namespace ceres {
class Problem;
}

namespace plumb::solve_pose_graph {

/// The covariance of each pose's move (v in the world [m], w in its own axes [rad]) beside the
/// fixed poses, whose entries are empty: the blocks on the diagonal of (J'J)^-1, from the problem's
/// present residuals and weights. `poses` are all of the problem's blocks, in space. Throws Error
/// where the problem leaves a direction free.
std::vector<std::optional<Matrix6d>> marginal_covariances(const ceres::Problem& problem,
                                                          std::span<const PoseBlock> poses);

/// The blocks of 6 x 6 on the diagonal of H^-1, H being symmetric, positive definite and of 6 x 6
/// blocks; H is given by its lower triangle. Only the entries of the inverse where the factor of H
/// has some are computed [Takahashi1973], so the time is that of the factorisation. Throws Error
/// where H is not positive definite.
std::vector<Matrix6d> diagonal_blocks_of_inverse(const Eigen::SparseMatrix<double>& lower);

}  // namespace plumb::solve_pose_graph
