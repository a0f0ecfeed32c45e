#include "rounds.hpp"

#include <ceres/solver.h>

#include <algorithm>
#include <cmath>

#include "plumb/data/error.hpp"
#include "uncertainty.hpp"

namespace plumb::solve_pose_graph {
namespace {

class Rounds {
 public:
  Rounds(const Poses& start, Terms& terms, const GraphOptions& options,
         const parallel::Loop& parallel)
      : start_(start), terms_(terms), options_(options), parallel_(parallel) {}

  Effort solve() {
    for (int round = 0; round < rounds(); ++round) {
      ++effort_.rounds;
      terms_.refresh(hardness(round));
      if (round > 0) weigh_constraints();
      const auto old = terms_.blocks();
      iterate();
      if (round >= annealing_rounds() && moved_since(old) <= options_.tolerance) break;
    }
    place_parts();
    terms_.refresh(hardness(rounds()));
    weigh_constraints();
    return effort_;
  }

 private:
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

  /// Variance component estimation: an edge's pairs share errors, so what an edge is worth beside
  /// the odometry shows in how far the edges disagree.
  void weigh_constraints() {
    if (!options_.estimate_variance || terms_.edges().empty()) return;
    terms_.weigh_sequential(std::sqrt(variance_factor(terms_, parallel_)) *
                            options_.uncertainty_factor);
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
    ceres::Solve(solver, &terms_.problem(), &summary);
    if (summary.termination_type == ceres::FAILURE)
      throw Error("the graph could not be solved: " + summary.message);
    effort_.iterations += std::max(
        0, static_cast<int>(summary.iterations.size()) - 1);  // none where nothing can move
  }

  /// [m] the largest move of a pose, its rotation taken at 10 m.
  double moved_since(const std::vector<PoseBlock>& old) const {
    double most = 0;
    for (std::uint32_t k = 0; k < old.size(); ++k) {
      const Pose before = pose_of(old[k].data()), now = terms_.pose(k);
      most = std::max({most, (now.translation - before.translation).norm(),
                       10 * angle(before.inverse() * now)});
    }
    return most;
  }

  /// Parts that nothing joins to the rest follow the pose before their first one.
  void place_parts() {
    const auto parts = terms_.parts().list();
    for (std::size_t n = 1; n < parts.size(); ++n) {
      if (terms_.is_held(n)) continue;
      const std::uint32_t before = parts[n].front() - 1;
      const Pose move = terms_.pose(before) * start_.T_world_segment[before].inverse();
      for (const auto v : parts[n]) terms_.place(v, move * terms_.pose(v));
    }
  }

  const Poses& start_;
  Terms& terms_;
  const GraphOptions& options_;
  const parallel::Loop& parallel_;
  Effort effort_;
};

}  // namespace

Effort solve_in_rounds(const Poses& start, Terms& terms, const GraphOptions& options,
                       const parallel::Loop& parallel) {
  return Rounds(start, terms, options, parallel).solve();
}

}  // namespace plumb::solve_pose_graph
