#include "uncertainty.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "marginals.hpp"
#include "plumb/data/error.hpp"
#include "plumb/slam/geometry/symmetric.hpp"

namespace plumb::solve_pose_graph {

double variance_factor(const Terms& terms, const parallel::Loop& parallel) {
  const auto& edges = terms.edges();
  std::vector<double> above(edges.size(), 0);
  parallel(edges.size(), [&](std::size_t k) {
    const EdgeState& edge = *edges[k];
    if (edge.pairs() < 6 || edge.edge().i == edge.edge().j) return;
    const auto cost_at = [&](const Pose& T) {
      return edge.form().residual(T.matrix(), T.translation).squaredNorm();
    };
    above[k] = std::max(0.0, cost_at(terms.T_j_i(edge.edge())) - cost_at(fitted(edge.form(), 5)));
  });
  double sum = 0, observed = 0;
  for (std::size_t k = 0; k < edges.size(); ++k)
    if (edges[k]->pairs() >= 6)
      sum += above[k], observed += 6 * std::clamp(edges[k]->mean_weight(), 0.0, 1.0);
  for (const auto& term : terms.relative()) {
    if (!term->robust && edges.empty()) observed += 6, sum += terms.squared(*term);
    if (term->robust && term->root_weight > 0.7) observed += 6, sum += terms.squared(*term);
  }
  double free = 0;
  for (const auto& block : terms.blocks())
    free += !terms.problem().IsParameterBlockConstant(block.data());
  const double freedom = observed - 6 * free;
  return freedom > 0 ? std::max(1e-4, sum / freedom) : 1;
}

void add_uncertainty(const Terms& terms, const GraphOptions& options,
                     const parallel::Loop& parallel, GraphResult& result) {
  std::vector<std::optional<Matrix6d>> covariances;
  try {
    covariances = marginal_covariances(terms.problem(), terms.blocks());
  } catch (const Error& e) {
    result.warnings.push_back(e.what());
    return;
  }
  const auto first = static_cast<std::uint32_t>(
      std::ranges::find_if(covariances, [](const auto& c) { return !c; }) - covariances.begin());
  const double variance = variance_factor(terms, parallel);
  const double factor = variance * options.uncertainty_factor * options.uncertainty_factor;
  for (std::uint32_t k = 0; k < covariances.size(); ++k) {
    if (!covariances[k]) continue;
    const Pose pose = terms.pose(k);
    // From moves (v in the world, w in the pose's axes) to what a constraint of g2o counts: [t;
    // q.vec] in the pose's axes.
    Matrix6d change = Matrix6d::Zero();
    change.topLeftCorner<3, 3>() = pose.matrix().transpose();
    change.bottomRightCorner<3, 3>() = 0.5 * Eigen::Matrix3d::Identity();
    Matrix6d covariance = factor * change * *covariances[k] * change.transpose();
    const double away =
        first < covariances.size() ? (pose.translation - terms.pose(first).translation).norm() : 0;
    covariance.diagonal().head<3>().array() += std::pow(options.uncertainty_per_metre * away, 2);
    result.uncertainty.absolute.push_back({k, pose, inverse_of_symmetric(covariance)});
  }
  result.metrics.add("variance_factor", variance, "");
}

}  // namespace plumb::solve_pose_graph
