#include "terms.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <utility>

#include "costs.hpp"
#include "plumb/data/counted.hpp"
#include "plumb/data/error.hpp"

namespace plumb::solve_pose_graph {

Terms::Terms(const Poses& start, std::span<const MatchedEdge> edges, const Constraints* constraints,
             const GraphOptions& options, const parallel::Loop& parallel)
    : options_(options), parallel_(parallel), parts_(start.size()) {
  for (const auto& pose : start.T_world_segment) blocks_.push_back(block_of(pose));
  check(edges, constraints);
  for (const auto& edge : edges) edges_.push_back(std::make_unique<EdgeState>(edge, options_));
  if (constraints) add_constraints(*constraints);
  add_priors(start);
  build(constraints);
}

void Terms::check(std::span<const MatchedEdge> edges, const Constraints* constraints) const {
  const auto has = [&](std::uint32_t i, const char* what) {
    if (i >= blocks_.size())
      throw Error(std::string(what) + " names pose " + std::to_string(i) + ", but got " +
                  counted(blocks_.size(), "poses") + "; wire poses of the same segments");
  };
  for (const auto& e : edges) has(e.edge.i, "an edge"), has(e.edge.j, "an edge");
  if (!constraints) return;
  for (const auto& r : constraints->relative) has(r.i, "a constraint"), has(r.j, "a constraint");
  for (const auto& r : constraints->absolute) has(r.i, "an absolute pose");
  for (const auto& r : constraints->points) has(r.i, "a control point");
}

void Terms::add_constraints(const Constraints& constraints) {
  planar_ = constraints.planar;
  named_.assign(blocks_.size() + 1, 0);
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
    relative_.push_back(std::move(term));
  }
  constraints_ = relative_.size();
}

/// From a pose to the next that any constraint names: between them lie at most poses that were
/// left out.
bool Terms::sequential(const RelativePose& r) const {
  return r.j > r.i && named_[r.j] == named_[r.i + 1];
}

std::vector<std::uint32_t> Terms::unnamed() const {
  std::vector<std::uint32_t> poses;
  for (std::uint32_t k = 0; k < blocks_.size(); ++k)
    if (named_[k + 1] == named_[k]) poses.push_back(k);
  return poses;
}

/// The shape that the poses came with, between neighbours: q.vec is half the rotation, hence the 4.
void Terms::add_priors(const Poses& start) {
  if (!options_.odometry_translation_sigma || !options_.odometry_rotation_sigma) return;
  for (std::uint32_t k = 0; k + 1 < start.size(); ++k) {
    auto term = std::make_unique<ConstraintTerm>();
    term->constraint = {k, k + 1, start.relative(k, k + 1), Matrix6d::Zero()};
    term->constraint.information.diagonal().head<3>().setConstant(
        std::pow(*options_.odometry_translation_sigma, -2));
    term->constraint.information.diagonal().tail<3>().setConstant(
        4 * std::pow(*options_.odometry_rotation_sigma, -2));
    term->cost = std::make_unique<G2oCost>(term->constraint, &term->root_weight);
    relative_.push_back(std::move(term));
  }
}

void Terms::build(const Constraints* constraints) {
  ceres::Problem::Options ownership;
  ownership.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ownership.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  problem_ = std::make_unique<ceres::Problem>(ownership);
  manifold_ = std::make_unique<PoseManifold>(planar_);
  for (auto& block : blocks_) problem_->AddParameterBlock(block.data(), 7, manifold_.get());

  std::vector<bool> absolute(blocks_.size(), false);
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
  for (const auto& term : relative_) {
    const auto [i, j] = std::pair(term->constraint.i, term->constraint.j);
    if (i == j) continue;
    problem_->AddResidualBlock(term->cost.get(), nullptr, blocks_[i].data(), blocks_[j].data());
    parts_.join(i, j);
  }
  if (constraints) {
    for (const auto& a : constraints->absolute) {
      add(std::make_unique<AbsolutePoseCost>(a), a.i);
      absolute[a.i] = true;
    }
    for (const auto& p : constraints->points) {
      add(std::make_unique<AbsolutePointCost>(p), p.i);
      absolute[p.i] = true;
    }
  }
  for (const auto& part : parts_.list()) {
    const bool held = std::any_of(part.begin(), part.end(), [&](auto v) { return absolute[v]; });
    if (!held) problem_->SetParameterBlockConstant(blocks_[part.front()].data());
    held_.push_back(held);
  }
}

void Terms::refresh(const Hardness& hardness) {
  parallel_(edges_.size(),
            [&](std::size_t k) { edges_[k]->refresh(T_j_i(edges_[k]->edge()), hardness); });
  const double scale = options_.constraint_scale * hardness.scale / options_.scale;
  for (auto& term : relative_) {
    if (!term->robust) continue;
    term->root_weight = 1;
    term->root_weight = std::sqrt(loss_weight(options_.loss, squared(*term) / (scale * scale)));
  }
}

void Terms::weigh_sequential(double root) {
  for (auto& term : relative_)
    if (!term->robust) term->root_weight = root;
}

double Terms::squared(const ConstraintTerm& term) const {
  const double* poses[2] = {blocks_[term.constraint.i].data(), blocks_[term.constraint.j].data()};
  Eigen::VectorXd residual(term.cost->num_residuals());
  term.cost->Evaluate(poses, residual.data(), nullptr);
  return residual.squaredNorm();
}

double Terms::cost() {
  std::vector<double> shares(edges_.size());
  parallel_(edges_.size(),
            [&](std::size_t k) { shares[k] = edges_[k]->cost(T_j_i(edges_[k]->edge())); });
  double sum = 0;
  for (const double share : shares) sum += share;
  const double scale2 = options_.constraint_scale * options_.constraint_scale;
  for (auto& term : relative_) {
    const double kept = std::exchange(term->root_weight, 1.0);  // with the information as given
    const double s = squared(*term);
    term->root_weight = kept;
    sum += term->robust ? scale2 * loss(options_.loss, s / scale2) : s;
  }
  for (const double square : absolute_squares()) sum += square;
  return sum;
}

/// The squared residual of each absolute pose and point.
std::vector<double> Terms::absolute_squares() const {
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

}  // namespace plumb::solve_pose_graph
