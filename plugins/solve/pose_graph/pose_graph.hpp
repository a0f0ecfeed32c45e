#pragma once
/// The pose graph: where every segment is, so that the pairs of all edges come together.

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "constraint_error.hpp"
#include "loss.hpp"
#include "plumb/slam/graph.hpp"
#include "plumb/slam/values.hpp"
#include "shared/parallel/loop.hpp"

namespace plumb::solve_pose_graph {

struct GraphOptions {
  Loss loss = Loss::huber;  ///< of each pair
  double scale = 0.5;  ///< [m] residual of a pair at which the loss begins to let go; also a pair's
                       ///< standard deviation
  std::optional<double>
      anneal_from;  ///< [m] scale of the first round; it shrinks geometrically to `scale`
  bool sequential_huber =
      true;  ///< pairs of sequential edges take huber where `loss` is cauchy or geman_mcclure
  Loss edge_loss =
      Loss::none;           ///< of each edge that is not sequential, on top of its pairs' losses
  double edge_scale = 1.0;  ///< [m] rms of an edge's pairs at which edge_loss begins to let go;
                            ///< annealed like `scale`
  std::optional<double> max_edge_weight =
      30;  ///< most that all pairs of an edge weigh together, in pairs; none: every pair counts
  std::optional<double> odometry_translation_sigma,
      odometry_rotation_sigma;  ///< [m], [rad]: see solve_pose_graph
  ConstraintError constraint_error = ConstraintError::g2o;
  double constraint_scale =
      3;  ///< standard deviations at which the loss lets go of a constraint that is not sequential
  int max_rounds = 30;             ///< at most: weights refreshed, solved again
  int max_iterations = 100;        ///< of Levenberg-Marquardt in each round, at most
  bool estimate_variance = false;  ///< whether edges count, beside sequential constraints, by how
                                   ///< far they disagree with each other
  bool uncertainty = false;        ///< whether the poses' covariances are computed
  double uncertainty_per_metre =
      4e-4;  ///< [m/m] deviation of a position that no disagreement shows, of its distance from the
             ///< first: clouds share a bias
  double uncertainty_factor =
      3;  ///< their deviations are multiplied by it: edges that share a segment share its errors
  double tolerance = 1e-4;  ///< [m] rounds end when no pose moves more, a rotation counting at 10 m

  /// Empty, or what does not go together.
  std::string check() const;
};

/// An edge and its pairs, which must live as long as the call.
struct MatchedEdge {
  Edge edge;
  const Matches* matches = nullptr;
};

struct GraphResult {
  Poses poses;
  Metrics metrics;
  std::vector<std::string> warnings;  ///< sentences: what fell apart
  Constraints uncertainty;  ///< if asked for: each pose but the fixed ones as an absolute pose with
                            ///< its marginal information
};

/// Poses T_k that minimise, starting from `start`,
///   sum over edges, over pairs   w rho(|T_i p - T_j q|^2 / scale^2)       (or the distance to the
///   plane at q)
/// + sum over constraints           rho(e'Omega e / constraint_scale^2) constraint_scale^2
/// + sum over consecutive poses   |v / odometry_translation_sigma|^2 + |w /
/// odometry_rotation_sigma|^2,   if both are given, v and w being what T_k^-1 T_k+1 differs from
/// what it is in `start`. Sequential constraints (no pose between i and j is named by any
/// constraint) have no loss. It is solved in rounds: weights rho' from the present residuals, all
/// pairs summed to one form per edge (pair_moments.hpp), Levenberg-Marquardt.
///
/// `estimate_variance`: after each round sequential constraints' information is multiplied by the
/// edges' variance factor (below) times uncertainty_factor^2, as if the edges' pairs had the
/// deviation that their disagreement shows instead of `scale`.
///
/// The first pose of each connected part stays as it is, unless an absolute constraint holds the
/// part. A part that no edge joins to the rest keeps its place relative to the pose before its
/// first one, and is warned of. `uncertainty`: H^-1 of the last round's normal equations, marginal
/// for each pose relative to the fixed first one, times a variance factor: the cost that the edges
/// have above their own best motions, by the degrees of freedom that the edges have more than the
/// poses. It is what the edges' disagreement with each other tells of their errors. Only in space.
/// The result does not depend on how `parallel` runs. Throws Error: an edge or constraint names a
/// pose that does not exist, pairs with planes but without normals, an information matrix with a
/// negative eigenvalue.
GraphResult solve_pose_graph(const Poses& start, std::span<const MatchedEdge> edges,
                             const Constraints* constraints, const GraphOptions& options,
                             const parallel::Loop& parallel);

}  // namespace plumb::solve_pose_graph
