#pragma once
/// How uncertain each pose is, beside the fixed ones.

#include <Eigen/SparseCore>
#include <vector>

#include "plumb/geometry/pose.hpp"

namespace plumb {

/// The blocks of 6 x 6 on the diagonal of H^-1, H being symmetric, positive definite and of 6 x 6 blocks; H is given by its lower triangle. Only the entries of the inverse
/// where the factor of H has some are computed [Takahashi1973], so the time is that of the factorisation. Throws Error where H is not positive definite.
std::vector<Matrix6d> diagonal_blocks_of_inverse(const Eigen::SparseMatrix<double>& lower);

}  // namespace plumb
