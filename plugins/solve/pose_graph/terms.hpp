#pragma once
/// The terms of the graph's cost under the present poses, each with its present weight, and the
/// problem in Ceres that sums them.

#include <ceres/cost_function.h>
#include <ceres/problem.h>

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "edge_state.hpp"
#include "parts.hpp"
#include "pose_manifold.hpp"

namespace plumb::solve_pose_graph {

/// A constraint's or prior's term, and the root of the weight that it has at present.
struct ConstraintTerm {
  RelativePose constraint;
  bool robust = false;  ///< whether the loss applies to it: it is not sequential
  std::unique_ptr<ceres::CostFunction> cost;
  double root_weight = 1;
};
using ConstraintTerms = std::span<const std::unique_ptr<ConstraintTerm>>;

/// The problem in Ceres, and all that it points into.
class Terms {
 public:
  /// Takes the matches, the options and the loop by reference. Throws Error where an edge or a
  /// constraint names a pose that there is not, and as EdgeState and the costs do.
  Terms(const Poses& start, std::span<const MatchedEdge> edges, const Constraints* constraints,
        const GraphOptions& options, const parallel::Loop& parallel);
  Terms(const Terms&) = delete;
  Terms& operator=(const Terms&) = delete;

  ceres::Problem& problem() { return *problem_; }
  const ceres::Problem& problem() const { return *problem_; }
  bool planar() const { return planar_; }

  const std::vector<PoseBlock>& blocks() const { return blocks_; }
  Pose pose(std::uint32_t k) const { return pose_of(blocks_[k].data()); }
  void place(std::uint32_t k, const Pose& pose) { blocks_[k] = block_of(pose); }
  Pose T_j_i(const Edge& e) const { return pose(e.j).inverse() * pose(e.i); }

  const std::vector<std::unique_ptr<EdgeState>>& edges() const { return edges_; }
  /// Constraints, then priors.
  ConstraintTerms relative() const { return relative_; }
  ConstraintTerms constraints() const { return relative().first(constraints_); }
  ConstraintTerms priors() const { return relative().subspan(constraints_); }
  /// Poses in order that no constraint names; only where there are constraints.
  std::vector<std::uint32_t> unnamed() const;

  /// What edges with pairs, constraints and priors join.
  const Parts& parts() const { return parts_; }
  /// Whether an absolute pose or point holds that part; where none does its first pose is fixed.
  bool is_held(std::size_t part) const { return held_[part]; }

  /// Weights from the residuals under the present poses.
  void refresh(const Hardness& hardness);
  /// Gives sequential constraints and priors this root of a weight.
  void weigh_sequential(double root);

  /// The term's squared residual under the present poses, times its present weight.
  double squared(const ConstraintTerm& term) const;
  /// The robust cost with the final scales: a sum of squares without a half.
  double cost();

 private:
  void check(std::span<const MatchedEdge> edges, const Constraints* constraints) const;
  void add_constraints(const Constraints& constraints);
  bool sequential(const RelativePose& r) const;
  void add_priors(const Poses& start);
  void build(const Constraints* constraints);
  std::vector<double> absolute_squares() const;

  const GraphOptions& options_;
  const parallel::Loop& parallel_;
  Parts parts_;
  bool planar_ = false;
  std::vector<PoseBlock> blocks_;
  std::vector<std::unique_ptr<EdgeState>> edges_;
  std::vector<std::unique_ptr<ConstraintTerm>> relative_;
  std::size_t constraints_ = 0;       ///< how many of them are no priors
  std::vector<std::uint32_t> named_;  ///< how many poses before each one a constraint names
  std::vector<std::unique_ptr<ceres::CostFunction>> owned_;
  std::unique_ptr<PoseManifold> manifold_;
  std::unique_ptr<ceres::Problem> problem_;
  std::vector<bool> held_;  ///< of each part
};

}  // namespace plumb::solve_pose_graph
