#include <algorithm>
#include <cmath>

#include "consistency.hpp"
#include "shared/point_pairs/rigid_fit.hpp"

namespace plumb::prune_consistency {
namespace {

/// Weight of a pair with squared residual `square` under the loss that `mu` makes of truncation at
/// `limit` (squared): 1 near 0, 0 beyond; between them it falls, the more steeply the larger mu.
double weight_of(double square, double limit, double mu) {
  if (square <= mu / (mu + 1) * limit) return 1;
  if (square >= (mu + 1) / mu * limit) return 0;
  return std::sqrt(limit * mu * (mu + 1) / square) - mu;
}

}  // namespace

std::vector<double> graduated_fit(const Matches& matches, const std::vector<std::uint32_t>& pairs,
                                  double max_distance, Pose& T_i_j) {
  constexpr double growth = 1.4;  // of mu, as in [Yang2020]
  constexpr int max_rounds = 100;
  const double limit = max_distance * max_distance;
  std::vector<double> weights(pairs.size(), 1), squares(pairs.size());
  double mu = 0;
  bool settled = false;
  for (int round = 0; round < max_rounds; ++round) {
    if (std::ranges::count_if(weights, [](double w) { return w > 0; }) < 3)
      return std::vector<double>(pairs.size(), 0);
    T_i_j = point_pairs::rigid_fit(matches.q, matches.p, pairs, weights);
    if (settled) break;
    for (std::size_t n = 0; n < pairs.size(); ++n)
      squares[n] =
          (matches.p[pairs[n]].cast<double>() - T_i_j * matches.q[pairs[n]].cast<double>().eval())
              .squaredNorm();
    if (round == 0) {
      const double worst = *std::ranges::max_element(squares);
      if (worst <= limit) break;
      mu = limit / (2 * worst - limit);
    }
    settled = true;  // where each pair counts wholly or not at all
    for (std::size_t n = 0; n < pairs.size(); ++n) {
      weights[n] = weight_of(squares[n], limit, mu);
      settled = settled && (weights[n] == 0 || weights[n] == 1);
    }
    mu *= growth;
  }
  return weights;
}

}  // namespace plumb::prune_consistency
