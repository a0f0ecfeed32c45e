#pragma once
/// Losses that let go of residuals larger than expected, as the weights of iteratively reweighted
/// least squares.

#include <cmath>

namespace plumb::solve_pose_graph {

enum class Loss { none, huber, cauchy, geman_mcclure };

/// rho(s) of a squared residual over its squared scale, s = (r / scale)^2; rho(s) is s for small s.
///   none s | huber s up to 1, then 2 sqrt(s) - 1 | cauchy log(1 + s) | geman_mcclure s / (1 + s)
/// The last alone has a bound: however wrong, a residual costs at most 1, so it lets go of a false
/// loop.
inline double loss(Loss kind, double s) {
  switch (kind) {
    case Loss::none:
      return s;
    case Loss::huber:
      return s <= 1 ? s : 2 * std::sqrt(s) - 1;
    case Loss::cauchy:
      return std::log1p(s);
    case Loss::geman_mcclure:
      return s / (1 + s);
  }
  return s;
}

/// rho'(s), the weight at which a squared residual counts: 1 at 0, never negative.
inline double loss_weight(Loss kind, double s) {
  switch (kind) {
    case Loss::none:
      return 1;
    case Loss::huber:
      return s <= 1 ? 1 : 1 / std::sqrt(s);
    case Loss::cauchy:
      return 1 / (1 + s);
    case Loss::geman_mcclure:
      return 1 / ((1 + s) * (1 + s));
  }
  return 1;
}

}  // namespace plumb::solve_pose_graph
