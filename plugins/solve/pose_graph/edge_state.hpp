#pragma once
/// One edge while the graph is solved: its pairs, their weights, and the form that sums them.

#include <algorithm>
#include <cstdint>

#include "plumb/slam/geometry/pair_moments.hpp"
#include "pose_graph.hpp"

namespace plumb::solve_pose_graph {

/// How hard the losses are in one round.
struct Hardness {
  double scale = 1;       ///< [m] of pairs
  double edge_scale = 1;  ///< [m] of edges
};

class EdgeState {
 public:
  /// Throws Error where planes are asked for and normals are missing. Takes the options by
  /// reference.
  EdgeState(const MatchedEdge& edge, const GraphOptions& options);

  const Edge& edge() const { return edge_; }
  std::size_t pairs() const { return matches_->size(); }

  /// Weights from the residuals under T_j_i, then the form about T_j_i with these weights over
  /// scale^2.
  void refresh(const Pose& T_j_i, const Hardness& hardness);

  /// The edge's share of the robust cost at T_j_i, with the final scales.
  double cost(const Pose& T_j_i) const;

  const PairForm& form() const { return form_; }
  const double* root_weight() const { return &one_; }
  std::uint32_t found() const {
    return std::max<std::uint32_t>(matches_->found, static_cast<std::uint32_t>(pairs()));
  }
  double mean_weight() const { return mean_weight_; }  ///< mean robust weight of its pairs, 0 to 1
  double rms() const { return rms_; }                  ///< [m] over all pairs
  double weighted_squares() const {
    return weighted_squares_;
  }                                                  ///< [m^2] sum w r^2 with robust weights
  double weight_sum() const { return weight_sum_; }  ///< sum of robust weights

 private:
  /// Calls body(k, p, difference d = T p - q, residual r^2) for each pair in order.
  template <class Body>
  void each_pair(const Pose& T_j_i, const Body& body) const;
  double given_weight(std::size_t k) const {
    return matches_->weight.empty() ? 1.0 : static_cast<double>(matches_->weight[k]);
  }
  Loss pair_loss() const {
    const bool held = options_.sequential_huber && edge_.kind == EdgeKind::sequential;
    return held && options_.loss != Loss::none ? Loss::huber : options_.loss;
  }
  Loss edge_loss() const {
    return edge_.kind == EdgeKind::sequential ? Loss::none : options_.edge_loss;
  }

  Edge edge_;
  const Matches* matches_;
  const GraphOptions& options_;
  Eigen::Vector3d centre_ = Eigen::Vector3d::Zero();
  double share_ = 1;  ///< what max_edge_weight leaves of each pair's weight
  PairForm form_;
  double one_ = 1;
  double mean_weight_ = 1, rms_ = 0, weighted_squares_ = 0, weight_sum_ = 0;
};

}  // namespace plumb::solve_pose_graph
