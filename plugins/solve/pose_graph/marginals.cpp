#include "marginals.hpp"

#include <Eigen/SparseCholesky>

#include "plumb/data/error.hpp"

namespace plumb {
namespace {

/// L (unit lower, columns sorted) and D of P H P' = L D L', and the inverse on L's pattern, from the last column to the first:
///   Z(i, j) = [i == j] / d_j - sum over k > j in L's column j of Z(i, k) L(k, j).
class SelectedInverse {
 public:
  explicit SelectedInverse(const Eigen::SparseMatrix<double>& lower) {
    factor_.compute(lower);
    if (factor_.info() != Eigen::Success || factor_.vectorD().minCoeff() <= 0)
      throw Error("the graph leaves a direction free, so its poses have no uncertainty: give odometry or more edges");
    l_ = factor_.matrixL();
    l_.makeCompressed();
    const auto n = l_.cols();
    inverse_.assign(static_cast<std::size_t>(l_.nonZeros()), 0);
    diagonal_.assign(static_cast<std::size_t>(n), 0);
    std::vector<double> column(static_cast<std::size_t>(n), 0);  // L(k, j) of the column at hand
    for (auto j = n - 1; j >= 0; --j) {
      const auto begin = l_.outerIndexPtr()[j], end = l_.outerIndexPtr()[j + 1];
      for (auto p = begin; p < end; ++p)
        if (l_.innerIndexPtr()[p] > j) column[static_cast<std::size_t>(l_.innerIndexPtr()[p])] = l_.valuePtr()[p];
      // Z(i, j) for i > j: sum over k in column j; Z(i, k) lies in column min(i, k). Gather by columns k.
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
        if (l_.innerIndexPtr()[p] > j) sum -= inverse_[static_cast<std::size_t>(p)] * l_.valuePtr()[p];
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
    return found != end && *found == i ? inverse_[static_cast<std::size_t>(found - l_.innerIndexPtr())] : 0;
  }

 private:
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor_;
  Eigen::SparseMatrix<double> l_;
  std::vector<double> inverse_, diagonal_;
};

}  // namespace

std::vector<Matrix6d> diagonal_blocks_of_inverse(const Eigen::SparseMatrix<double>& lower) {
  const SelectedInverse inverse(lower);
  std::vector<Matrix6d> blocks(static_cast<std::size_t>(lower.cols() / 6));
  for (std::size_t k = 0; k < blocks.size(); ++k)
    for (int a = 0; a < 6; ++a)
      for (int b = 0; b < 6; ++b) blocks[k](a, b) = inverse.at(6 * static_cast<Eigen::Index>(k) + a, 6 * static_cast<Eigen::Index>(k) + b);
  return blocks;
}

}  // namespace plumb
