#include "pose_graph.hpp"

#include <ceres/problem.h>
#include <ceres/solver.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <memory>
#include <numeric>
#include <utility>

#include "costs.hpp"
#include "edge_state.hpp"
#include "marginals.hpp"
#include "parts.hpp"
#include "plumb/data/counted.hpp"
#include "plumb/data/error.hpp"
#include "pose_manifold.hpp"
#include "verdict.hpp"

namespace plumb::solve_pose_graph {
namespace {

/// A constraint's or prior's term, and the robust weight it has in this round.
struct ConstraintTerm {
  RelativePose constraint;
  bool robust = false;
  std::unique_ptr<ceres::CostFunction> cost;
  double root_weight = 1;
};

/// The problem in Ceres, and all that it points into.
class Graph {
 public:
  Graph(const Poses& start, std::span<const MatchedEdge> edges, const Constraints* constraints,
        const GraphOptions& options, const parallel::Loop& parallel)
      : start_(start), options_(options), parallel_(parallel), parts_(start.size()) {
    for (const auto& pose : start.T_world_segment) blocks_.push_back(block_of(pose));
    check(edges, constraints);
    for (const auto& edge : edges) edges_.push_back(std::make_unique<EdgeState>(edge, options_));
    if (constraints) add_constraints(*constraints);
    add_priors();
    build(constraints);
  }

  GraphResult solve() {
    const double before = cost();
    for (int round = 0; round < rounds(); ++round) {
      ++rounds_used_;
      refresh(hardness(round));
      if (round > 0) weigh_constraints();
      const auto old = blocks_;
      iterate();
      if (round >= annealing_rounds() && moved_since(old) <= options_.tolerance) break;
    }
    place_parts();
    refresh(hardness(rounds()));
    weigh_constraints();
    return result(before);
  }

 private:
  // ---- building
  // -------------------------------------------------------------------------------------------------------------

  void check(std::span<const MatchedEdge> edges, const Constraints* constraints) const {
    const auto has = [&](std::uint32_t i, const char* what) {
      if (i >= start_.size())
        throw Error(std::string(what) + " names pose " + std::to_string(i) + ", but got " +
                    counted(start_.size(), "poses") + "; wire poses of the same segments");
    };
    for (const auto& e : edges) has(e.edge.i, "an edge"), has(e.edge.j, "an edge");
    if (!constraints) return;
    for (const auto& r : constraints->relative) has(r.i, "a constraint"), has(r.j, "a constraint");
    for (const auto& r : constraints->absolute) has(r.i, "an absolute pose");
    for (const auto& r : constraints->points) has(r.i, "a control point");
  }

  void add_constraints(const Constraints& constraints) {
    planar_ = constraints.planar;
    named_.assign(start_.size() + 1, 0);  // how many poses before each one a constraint names
    for (const auto& constraint : constraints.relative)
      named_[constraint.i + 1] = named_[constraint.j + 1] = 1;
    std::partial_sum(named_.begin(), named_.end(), named_.begin());
    for (const auto& constraint : constraints.relative) {
      auto term = std::make_unique<ConstraintTerm>();
      term->constraint = constraint;
      term->robust = !sequential(constraint);
      if (options_.constraint_error == ConstraintError::chordal)
        term->cost = std::make_unique<ChordalCost>(constraint, planar_, &term->root_weight);
      else
        term->cost = std::make_unique<G2oCost>(constraint, &term->root_weight);
      terms_.push_back(std::move(term));
    }
    constraints_ = terms_.size();
  }

  /// From a pose to the next that any constraint names: between them lie at most poses that were
  /// left out.
  bool sequential(const RelativePose& r) const {
    return r.j > r.i && named_[r.j] == named_[r.i + 1];
  }

  std::vector<std::uint32_t> unnamed() const {
    std::vector<std::uint32_t> poses;
    for (std::uint32_t k = 0; k < start_.size(); ++k)
      if (named_[k + 1] == named_[k]) poses.push_back(k);
    return poses;
  }

  /// The shape that the poses came with, between neighbours: q.vec is half the rotation, hence
  /// the 4.
  void add_priors() {
    if (!options_.odometry_translation_sigma || !options_.odometry_rotation_sigma) return;
    for (std::uint32_t k = 0; k + 1 < start_.size(); ++k) {
      auto term = std::make_unique<ConstraintTerm>();
      term->constraint = {k, k + 1, start_.relative(k, k + 1), Matrix6d::Zero()};
      term->constraint.information.diagonal().head<3>().setConstant(
          std::pow(*options_.odometry_translation_sigma, -2));
      term->constraint.information.diagonal().tail<3>().setConstant(
          4 * std::pow(*options_.odometry_rotation_sigma, -2));
      term->cost = std::make_unique<G2oCost>(term->constraint, &term->root_weight);
      terms_.push_back(std::move(term));
    }
  }

  void build(const Constraints* constraints) {
    ceres::Problem::Options ownership;
    ownership.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    ownership.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    problem_ = std::make_unique<ceres::Problem>(ownership);
    manifold_ = std::make_unique<PoseManifold>(planar_);
    for (auto& block : blocks_) problem_->AddParameterBlock(block.data(), 7, manifold_.get());

    std::vector<bool> held(blocks_.size(), false);
    const auto add = [&](std::unique_ptr<ceres::CostFunction> cost, auto... vertex) {
      problem_->AddResidualBlock(cost.get(), nullptr, blocks_[vertex].data()...);
      owned_.push_back(std::move(cost));
    };
    for (const auto& edge : edges_) {
      const auto [i, j] = std::pair(edge->edge().i, edge->edge().j);
      if (edge->pairs() == 0 || i == j) continue;
      add(std::make_unique<PairCost>(&edge->form(), edge->root_weight()), i, j);
      parts_.join(i, j);
    }
    for (const auto& term : terms_) {
      const auto [i, j] = std::pair(term->constraint.i, term->constraint.j);
      if (i == j) continue;
      problem_->AddResidualBlock(term->cost.get(), nullptr, blocks_[i].data(), blocks_[j].data());
      parts_.join(i, j);
    }
    if (constraints) {
      for (const auto& a : constraints->absolute) {
        add(std::make_unique<AbsolutePoseCost>(a), a.i);
        held[a.i] = true;
      }
      for (const auto& p : constraints->points) {
        add(std::make_unique<AbsolutePointCost>(p), p.i);
        held[p.i] = true;
      }
    }
    for (const auto& part : parts_.list()) {
      const bool absolute = std::any_of(part.begin(), part.end(), [&](auto v) { return held[v]; });
      if (!absolute) problem_->SetParameterBlockConstant(blocks_[part.front()].data());
      absolute_.push_back(absolute);
    }
  }

  // ---- rounds
  // ---------------------------------------------------------------------------------------------------------------

  bool reweighted() const {
    return options_.loss != Loss::none || options_.edge_loss != Loss::none ||
           options_.estimate_variance;
  }
  int rounds() const { return reweighted() ? options_.max_rounds : 1; }
  /// Two thirds of the rounds shrink the scales; the rest have the final ones.
  int annealing_rounds() const {
    return reweighted() && options_.anneal_from ? 2 * options_.max_rounds / 3 : 0;
  }
  Hardness hardness(int round) const {
    double factor = 1;
    if (const int shrinking = annealing_rounds(); round < shrinking)
      factor = std::pow(std::max(1.0, *options_.anneal_from / options_.scale),
                        1 - static_cast<double>(round) / shrinking);
    return {factor * options_.scale, factor * options_.edge_scale};
  }

  Pose pose(std::uint32_t k) const { return pose_of(blocks_[k].data()); }
  Pose T_j_i(const Edge& e) const { return pose(e.j).inverse() * pose(e.i); }

  void refresh(const Hardness& hardness) {
    parallel_(edges_.size(),
              [&](std::size_t k) { edges_[k]->refresh(T_j_i(edges_[k]->edge()), hardness); });
    const double scale = options_.constraint_scale * hardness.scale / options_.scale;
    for (auto& term : terms_) {
      if (!term->robust) continue;
      term->root_weight = 1;
      term->root_weight = std::sqrt(loss_weight(options_.loss, squared(*term) / (scale * scale)));
    }
  }

  /// Variance component estimation: an edge's pairs share errors, so what an edge is worth beside
  /// the odometry shows in how far the edges disagree.
  void weigh_constraints() {
    if (!options_.estimate_variance || edges_.empty()) return;
    const double root = std::sqrt(variance_factor()) * options_.uncertainty_factor;
    for (auto& term : terms_)
      if (!term->robust) term->root_weight = root;
  }

  /// The term's squared residual under the present poses, times its present weight.
  double squared(const ConstraintTerm& term) const {
    const double* poses[2] = {blocks_[term.constraint.i].data(), blocks_[term.constraint.j].data()};
    Eigen::VectorXd residual(term.cost->num_residuals());
    term.cost->Evaluate(poses, residual.data(), nullptr);
    return residual.squaredNorm();
  }

  void iterate() {
    ceres::Solver::Options solver;
    solver.max_num_iterations = options_.max_iterations;
    solver.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
    solver.sparse_linear_algebra_library_type = ceres::EIGEN_SPARSE;
    solver.num_threads = 1;  // the same sums in the same order
    solver.logging_type = ceres::SILENT;
    // Nearly Gauss-Newton: a long chain bends by directions that are a million times softer than
    // the stiffest, and Ceres' own start (1e4) would damp just these, so that each round moves them
    // by a part. Where a step fails the radius shrinks by itself.
    solver.initial_trust_region_radius = 1e8;
    // Rounds with weights to refresh need no more than weights are worth; a single one goes to the
    // end.
    solver.function_tolerance = reweighted() ? 1e-4 : 1e-12;
    solver.parameter_tolerance = 1e-12;
    solver.gradient_tolerance = 1e-12;
    ceres::Solver::Summary summary;
    ceres::Solve(solver, problem_.get(), &summary);
    if (summary.termination_type == ceres::FAILURE)
      throw Error("the graph could not be solved: " + summary.message);
    iterations_used_ += std::max(
        0, static_cast<int>(summary.iterations.size()) - 1);  // none where nothing can move
  }

  /// [m] the largest move of a pose, its rotation taken at 10 m.
  double moved_since(const std::vector<PoseBlock>& old) const {
    double most = 0;
    for (std::uint32_t k = 0; k < blocks_.size(); ++k) {
      const Pose before = pose_of(old[k].data()), now = pose(k);
      most = std::max({most, (now.translation - before.translation).norm(),
                       10 * angle(before.inverse() * now)});
    }
    return most;
  }

  /// Parts that nothing joins to the rest follow the pose before their first one.
  void place_parts() {
    const auto parts = parts_.list();
    for (std::size_t n = 1; n < parts.size(); ++n) {
      if (absolute_[n]) continue;
      const std::uint32_t before = parts[n].front() - 1;
      const Pose move = pose(before) * start_.T_world_segment[before].inverse();
      for (const auto v : parts[n]) blocks_[v] = block_of(move * pose(v));
    }
  }

  // ---- results
  // --------------------------------------------------------------------------------------------------------------

  /// The robust cost with the final scales: a sum of squares without a half.
  double cost() {
    std::vector<double> shares(edges_.size());
    parallel_(edges_.size(),
              [&](std::size_t k) { shares[k] = edges_[k]->cost(T_j_i(edges_[k]->edge())); });
    double sum = 0;
    for (const double share : shares) sum += share;
    const double scale2 = options_.constraint_scale * options_.constraint_scale;
    for (auto& term : terms_) {
      const double kept = std::exchange(term->root_weight, 1.0);  // with the information as given
      const double s = squared(*term);
      term->root_weight = kept;
      sum += term->robust ? scale2 * loss(options_.loss, s / scale2) : s;
    }
    for (const auto& single : absolute_terms()) sum += single;
    return sum;
  }
  std::vector<double> absolute_terms() const {
    std::vector<double> squares;
    std::vector<ceres::ResidualBlockId> ids;
    problem_->GetResidualBlocks(&ids);
    for (const auto id : ids) {
      std::vector<double*> blocks;
      problem_->GetParameterBlocksForResidualBlock(id, &blocks);
      if (blocks.size() != 1) continue;
      double half = 0;
      problem_->EvaluateResidualBlock(id, false, &half, nullptr, nullptr);
      squares.push_back(2 * half);
    }
    return squares;
  }

  GraphResult result(double before) {
    GraphResult result;
    for (std::uint32_t k = 0; k < blocks_.size(); ++k)
      result.poses.T_world_segment.push_back(pose(k));
    Verdict verdict(start_.size());
    for (const auto& edge : edges_) verdict.add(*edge);
    for (std::size_t k = 0; k < constraints_; ++k) {
      const auto& r = terms_[k]->constraint;
      if (!edges_.empty() &&
          !terms_[k]
               ->robust) {  // beside matches a chain is what the odometry knows, no edge of its own
        verdict.joined_by_prior();
        continue;
      }
      const Pose error = r.T_i_j.inverse() * (pose(r.i).inverse() * pose(r.j));
      verdict.add(r, !terms_[k]->robust, error.translation.norm(),
                  terms_[k]->root_weight * terms_[k]->root_weight);
    }
    if (terms_.size() > constraints_) verdict.joined_by_prior();
    if (edges_.empty() && constraints_ > 0) verdict.left_out(unnamed());
    result.metrics = verdict.metrics(before, cost(), rounds_used_, iterations_used_);
    result.warnings = verdict.warnings(parts_.list());
    if (options_.uncertainty && !planar_) add_uncertainty(result);
    return result;
  }

  // ---- uncertainty
  // ----------------------------------------------------------------------------------------------------------

  /// The mean cost, by degree of freedom, that edges and constraints have above the best that each
  /// could have alone: 1 where they disagree as much as their weights say.
  double variance_factor() const {
    std::vector<double> above(edges_.size(), 0);
    parallel_(edges_.size(), [&](std::size_t k) {
      const EdgeState& edge = *edges_[k];
      if (edge.pairs() < 6 || edge.edge().i == edge.edge().j) return;
      const auto cost_at = [&](const Pose& T) {
        return edge.form().residual(T.matrix(), T.translation).squaredNorm();
      };
      above[k] = std::max(0.0, cost_at(T_j_i(edge.edge())) - cost_at(fitted(edge.form(), 5)));
    });
    double sum = 0, terms = 0;
    for (std::size_t k = 0; k < edges_.size(); ++k)
      if (edges_[k]->pairs() >= 6)
        sum += above[k], terms += 6 * std::clamp(edges_[k]->mean_weight(), 0.0, 1.0);
    for (const auto& term : terms_) {
      if (!term->robust && edges_.empty()) terms += 6, sum += squared(*term);
      if (term->robust && term->root_weight > 0.7) terms += 6, sum += squared(*term);
    }
    double free = 0;
    for (const auto& block : blocks_) free += !problem_->IsParameterBlockConstant(block.data());
    const double freedom = terms - 6 * free;
    return freedom > 0 ? std::max(1e-4, sum / freedom) : 1;
  }

  void add_uncertainty(GraphResult& result) const {
    std::vector<std::optional<Matrix6d>> covariances;
    try {
      covariances = marginal_covariances(*problem_, blocks_);
    } catch (const Error& e) {
      result.warnings.push_back(e.what());
      return;
    }
    const auto first = static_cast<std::uint32_t>(
        std::ranges::find_if(covariances, [](const auto& c) { return !c; }) - covariances.begin());
    const double factor =
        variance_factor() * options_.uncertainty_factor * options_.uncertainty_factor;
    for (std::uint32_t k = 0; k < blocks_.size(); ++k) {
      if (!covariances[k]) continue;
      // From moves (v in the world, w in the pose's axes) to what a constraint of g2o counts: [t;
      // q.vec] in the pose's axes.
      Matrix6d change = Matrix6d::Zero();
      change.topLeftCorner<3, 3>() = pose(k).matrix().transpose();
      change.bottomRightCorner<3, 3>() = 0.5 * Eigen::Matrix3d::Identity();
      Matrix6d covariance = factor * change * *covariances[k] * change.transpose();
      const double away =
          first < blocks_.size() ? (pose(k).translation - pose(first).translation).norm() : 0;
      covariance.diagonal().head<3>().array() += std::pow(options_.uncertainty_per_metre * away, 2);
      result.uncertainty.absolute.push_back(
          {k, pose(k), covariance.ldlt().solve(Matrix6d::Identity())});
    }
    result.metrics.add("variance_factor", variance_factor(), "");
  }

  // ---- data
  // -----------------------------------------------------------------------------------------------------------------

  const Poses& start_;
  const GraphOptions& options_;
  const parallel::Loop& parallel_;
  Parts parts_;
  bool planar_ = false;
  std::vector<PoseBlock> blocks_;
  std::vector<std::unique_ptr<EdgeState>> edges_;
  std::vector<std::unique_ptr<ConstraintTerm>> terms_;  ///< constraints first, then priors
  std::size_t constraints_ = 0;
  std::vector<std::uint32_t> named_;
  std::vector<std::unique_ptr<ceres::CostFunction>> owned_;
  std::unique_ptr<PoseManifold> manifold_;
  std::unique_ptr<ceres::Problem> problem_;
  std::vector<bool> absolute_;  ///< of each part
  int rounds_used_ = 0, iterations_used_ = 0;
};

}  // namespace

std::string GraphOptions::check() const {
  if (odometry_translation_sigma.has_value() != odometry_rotation_sigma.has_value())
    return "odometry_translation_sigma and odometry_rotation_sigma go together; give both or "
           "neither";
  if (anneal_from && *anneal_from < scale)
    return "anneal_from must not be smaller than scale, to which it shrinks";
  return "";
}

GraphResult solve_pose_graph(const Poses& start, std::span<const MatchedEdge> edges,
                             const Constraints* constraints, const GraphOptions& options,
                             const parallel::Loop& parallel) {
  if (start.size() == 0) throw Error("there are no poses to solve for");
  return Graph(start, edges, constraints, options, parallel).solve();
}

}  // namespace plumb::solve_pose_graph
