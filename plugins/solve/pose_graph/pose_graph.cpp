#include "pose_graph.hpp"

#include "plumb/data/error.hpp"
#include "rounds.hpp"
#include "uncertainty.hpp"
#include "verdict.hpp"

namespace plumb::solve_pose_graph {
namespace {

Verdict verdict_of(const Terms& terms) {
  Verdict verdict(terms.blocks().size());
  for (const auto& edge : terms.edges()) verdict.add(*edge);
  for (const auto& term : terms.constraints()) {
    const auto& r = term->constraint;
    if (!terms.edges().empty() && !term->robust) {
      // Beside matches a chain is what the odometry knows, no edge of its own.
      verdict.joined_by_prior();
      continue;
    }
    const Pose error = r.T_i_j.inverse() * (terms.pose(r.i).inverse() * terms.pose(r.j));
    verdict.add(r, !term->robust, error.translation.norm(), term->root_weight * term->root_weight);
  }
  if (!terms.priors().empty()) verdict.joined_by_prior();
  if (terms.edges().empty() && !terms.constraints().empty()) verdict.left_out(terms.unnamed());
  return verdict;
}

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
  Terms terms(start, edges, constraints, options, parallel);
  const double before = terms.cost();
  const Effort effort = solve_in_rounds(start, terms, options, parallel);

  GraphResult result;
  for (std::uint32_t k = 0; k < start.size(); ++k)
    result.poses.T_world_segment.push_back(terms.pose(k));
  Verdict verdict = verdict_of(terms);
  result.metrics = verdict.metrics(before, terms.cost(), effort.rounds, effort.iterations);
  result.warnings = verdict.warnings(terms.parts().list());
  if (options.uncertainty && !terms.planar()) add_uncertainty(terms, options, parallel, result);
  return result;
}

}  // namespace plumb::solve_pose_graph
