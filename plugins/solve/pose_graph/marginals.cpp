#include "marginals.hpp"

#include <ceres/cost_function.h>
#include <ceres/problem.h>

#include <Eigen/SparseCholesky>

#include "plumb/data/error.hpp"

namespace plumb::solve_pose_graph {
namespace {

/// L (unit lower, columns sorted) and D of P H P' = L D L', and the inverse on L's pattern, from
/// the last column to the first:
///   Z(i, j) = [i == j] / d_j - sum over k > j in L's column j of Z(i, k) L(k, j).
class SelectedInverse {
 public:
  explicit SelectedInverse(const Eigen::SparseMatrix<double>& lower) {
    factor_.compute(lower);
    if (factor_.info() != Eigen::Success || factor_.vectorD().minCoeff() <= 0)
      throw Error(
          "the graph leaves a direction free, so its poses have no uncertainty: give odometry or "
          "more edges");
    l_ = factor_.matrixL();
    l_.makeCompressed();
    const auto n = l_.cols();
    inverse_.assign(static_cast<std::size_t>(l_.nonZeros()), 0);
    diagonal_.assign(static_cast<std::size_t>(n), 0);
    std::vector<double> column(static_cast<std::size_t>(n), 0);  // L(k, j) of the column at hand
    for (auto j = n - 1; j >= 0; --j) {
      const auto begin = l_.outerIndexPtr()[j], end = l_.outerIndexPtr()[j + 1];
      for (auto p = begin; p < end; ++p)
        if (l_.innerIndexPtr()[p] > j)
          column[static_cast<std::size_t>(l_.innerIndexPtr()[p])] = l_.valuePtr()[p];
      // Z(i, j) for i > j: sum over k in column j; Z(i, k) lies in column min(i, k). Gather by
      // columns k.
      for (auto p = begin; p < end; ++p) {
        const auto k = l_.innerIndexPtr()[p];
        if (k <= j) continue;
        const double l_kj = l_.valuePtr()[p];
        inverse_[static_cast<std::size_t>(p)] -= diagonal_[static_cast<std::size_t>(k)] * l_kj;
        // Entries Z(i, k), i > k, serve Z(i, j) with L(k, j) and Z(k, j) with L(i, j).
        auto at = p + 1;
        for (auto q = l_.outerIndexPtr()[k]; q < l_.outerIndexPtr()[k + 1] && at < end; ++q) {
          const auto i = l_.innerIndexPtr()[q];
          if (i <= k) continue;
          while (at < end && l_.innerIndexPtr()[at] < i) ++at;
          if (at == end || l_.innerIndexPtr()[at] != i) continue;
          const double z = inverse_[static_cast<std::size_t>(q)];
          inverse_[static_cast<std::size_t>(at)] -= z * l_kj;
          inverse_[static_cast<std::size_t>(p)] -= z * column[static_cast<std::size_t>(i)];
        }
      }
      double sum = 1 / factor_.vectorD()[j];
      for (auto p = begin; p < end; ++p)
        if (l_.innerIndexPtr()[p] > j)
          sum -= inverse_[static_cast<std::size_t>(p)] * l_.valuePtr()[p];
      diagonal_[static_cast<std::size_t>(j)] = sum;
    }
  }

  /// Entry (a, b) of H^-1, both in the same block, or where H has an entry.
  double at(Eigen::Index a, Eigen::Index b) const {
    const auto& place = factor_.permutationP().indices();
    auto i = place[a], j = place[b];
    if (i == j) return diagonal_[static_cast<std::size_t>(i)];
    if (i < j) std::swap(i, j);
    const auto* begin = l_.innerIndexPtr() + l_.outerIndexPtr()[j];
    const auto* end = l_.innerIndexPtr() + l_.outerIndexPtr()[j + 1];
    const auto* found = std::lower_bound(begin, end, i);
    return found != end && *found == i
               ? inverse_[static_cast<std::size_t>(found - l_.innerIndexPtr())]
               : 0;
  }

 private:
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor_;
  Eigen::SparseMatrix<double> l_;
  std::vector<double> inverse_, diagonal_;
};

/// J'J of one term, with the derivatives by (v, w) that stand in the first six columns of each
/// block. `place` counts the free poses.
void add_normal_equations(const ceres::Problem& problem, ceres::ResidualBlockId id,
                          std::span<const PoseBlock> all, const std::vector<int>& place,
                          std::vector<Eigen::Triplet<double>>& entries) {
  const ceres::CostFunction* cost = problem.GetCostFunctionForResidualBlock(id);
  std::vector<double*> poses;
  problem.GetParameterBlocksForResidualBlock(id, &poses);
  const int rows = cost->num_residuals();
  using Jacobian = Eigen::Matrix<double, Eigen::Dynamic, 7, Eigen::RowMajor>;
  std::vector<Jacobian> jacobians(poses.size(), Jacobian(rows, 7));
  std::vector<double*> to;
  for (auto& jacobian : jacobians) to.push_back(jacobian.data());
  Eigen::VectorXd residual(rows);
  cost->Evaluate(poses.data(), residual.data(), to.data());
  const auto vertex = [&](std::size_t n) {
    return place[static_cast<std::size_t>(reinterpret_cast<const PoseBlock*>(poses[n]) -
                                          all.data())];
  };
  for (std::size_t a = 0; a < poses.size(); ++a)
    for (std::size_t b = 0; b < poses.size(); ++b) {
      const int row = vertex(a), column = vertex(b);
      if (row < 0 || column < 0 || row < column) continue;
      const Matrix6d block = jacobians[a].leftCols<6>().transpose() * jacobians[b].leftCols<6>();
      for (int i = 0; i < 6; ++i)
        for (int j = 0; j < 6; ++j)
          if (row > column || i >= j)
            entries.emplace_back(6 * row + i, 6 * column + j, block(i, j));
    }
}

}  // namespace

std::vector<std::optional<Matrix6d>> marginal_covariances(const ceres::Problem& problem,
                                                          std::span<const PoseBlock> poses) {
  std::vector<int> place(poses.size(), -1);
  int free = 0;
  for (std::size_t k = 0; k < poses.size(); ++k)
    if (!problem.IsParameterBlockConstant(poses[k].data())) place[k] = free++;
  std::vector<std::optional<Matrix6d>> covariances(poses.size());
  if (free == 0) return covariances;
  std::vector<Eigen::Triplet<double>> entries;
  std::vector<ceres::ResidualBlockId> ids;
  problem.GetResidualBlocks(&ids);
  for (const auto id : ids) add_normal_equations(problem, id, poses, place, entries);
  Eigen::SparseMatrix<double> lower(6 * free, 6 * free);
  lower.setFromTriplets(entries.begin(), entries.end());
  const auto blocks = diagonal_blocks_of_inverse(lower);
  for (std::size_t k = 0; k < poses.size(); ++k)
    if (place[k] >= 0) covariances[k] = blocks[static_cast<std::size_t>(place[k])];
  return covariances;
}

std::vector<Matrix6d> diagonal_blocks_of_inverse(const Eigen::SparseMatrix<double>& lower) {
  const SelectedInverse inverse(lower);
  std::vector<Matrix6d> blocks(static_cast<std::size_t>(lower.cols() / 6));
  for (std::size_t k = 0; k < blocks.size(); ++k)
    for (int a = 0; a < 6; ++a)
      for (int b = 0; b < 6; ++b)
        blocks[k](a, b) =
            inverse.at(6 * static_cast<Eigen::Index>(k) + a, 6 * static_cast<Eigen::Index>(k) + b);
  return blocks;
}

}  // namespace plumb::solve_pose_graph
