#include "plumb/slam/step.hpp"

#include "plumb/plugin/module.hpp"
#include "pose_graph.hpp"

namespace plumb::solve_pose_graph {
namespace {

const std::vector<ChoiceOf<Loss>> losses = {
    {"none", Loss::none, "least squares"},
    {"huber", Loss::huber,
     "weight 1, beyond the scale decreasing with 1 / r: large residuals still pull"},
    {"cauchy", Loss::cauchy, "weight decreasing with 1 / r^2"},
    {"geman_mcclure", Loss::geman_mcclure, "weight decreasing with 1 / r^4: rejects outliers"}};

struct SolvePoseGraph : WholeStep {
  struct In {
    One<Poses> poses;
    Each<Matches> matches;
    Several<Constraints> constraints;
    One<Metrics> scale;
  };
  struct Out {
    Poses poses;
    Metrics metrics;
    Constraints uncertainty;
  };
  using Params = GraphOptions;

  static void describe(Declaration<SolvePoseGraph>& is) {
    is.name("solve.pose_graph")
        .version(2)
        .summary("Optimizes the poses of all segments so that matches and constraints agree.")
        .source(
            "[Tang2024] 2.1, 2.4.1; the other losses, the bounds on weights and pairs to planes "
            "are ours");
    is.input("poses", &In::poses, "initial poses of the segments");
    is.optional_input("matches", &In::matches, "point pairs of each edge");
    is.optional_input(
        "constraints", &In::constraints,
        "measured relative poses, absolute poses and points; several lists are concatenated");
    is.scale(&In::scale);
    is.output("poses", &Out::poses, "optimized poses of the segments");
    is.output("metrics", &Out::metrics, "cost, residual, and the status of each edge");
    is.output("uncertainty", &Out::uncertainty,
              "with 'uncertainty: true', the uncertainty of each pose relative to the first: "
              "absolute poses with their information");
    describe_matches(is);
    describe_constraints(is);
    is.param("max_rounds", &Params::max_rounds)
        .range(1, 1000)
        .doc("rounds of reweighting; with anneal_from two thirds of them shrink the scale");
    is.param("max_iterations", &Params::max_iterations)
        .range(1, 10000)
        .doc("iterations of Levenberg-Marquardt in one round");
    describe_uncertainty(is);
    is.param("tolerance", &Params::tolerance)
        .unit("m")
        .range(0, 1)
        .doc("rounds end when no pose moves by more than this, a rotation taken at 10 m");
  }

  Out run(const In& in, const Params& params, Context& context) const {
    if (!in.matches && in.constraints.empty())
      throw Error("solve.pose_graph has nothing to solve: wire 'matches', 'constraints' or both");
    std::vector<One<Matches>> held;
    std::vector<MatchedEdge> edges;
    if (in.matches) {
      held.resize(in.matches.size());
      context.parallel(held.size(), [&](std::size_t k) { held[k] = in.matches.open(k); });
      for (std::size_t k = 0; k < held.size(); ++k)
        edges.push_back({edges_of(in.matches).list[k], &*held[k]});
    }
    const Constraints constraints = joined(in.constraints);
    auto result =
        solve_pose_graph(*in.poses, edges, in.constraints.empty() ? nullptr : &constraints, params,
                         [&](std::size_t n, const auto& body) { context.parallel(n, body); });
    for (const auto& warning : result.warnings) context.warn(warning);
    return {std::move(result.poses), std::move(result.metrics), std::move(result.uncertainty)};
  }

 private:
  static void describe_matches(Declaration<SolvePoseGraph>& is) {
    is.choice("loss", &Params::loss, losses)
        .doc("robust loss of a pair's squared residual")
        .source("[Tang2024] 2.4.1 for huber");
    is.param("scale", &Params::scale)
        .unit("m")
        .range(1e-4, 1000)
        .doc(
            "residual of a pair at which the loss begins to down-weight; also the standard "
            "deviation of a pair, relative to constraints and odometry");
    is.param("anneal_from", &Params::anneal_from)
        .unit("m")
        .range(1e-4, 1e6)
        .doc(
            "scale of the first round, which shrinks geometrically to 'scale', so that wrong edges "
            "are rejected one by one");
    is.param("sequential_huber", &Params::sequential_huber)
        .doc(
            "with cauchy and geman_mcclure the pairs of sequential edges have the huber loss "
            "instead, so that they are never rejected");
    is.choice("edge_loss", &Params::edge_loss, losses)
        .doc(
            "robust loss of the RMS residual of an edge that is not sequential, in addition to its "
            "pairs' losses");
    is.param("edge_scale", &Params::edge_scale)
        .unit("m")
        .range(1e-4, 1000)
        .doc(
            "RMS residual of an edge at which edge_loss begins to down-weight; annealed like "
            "'scale'");
    is.param("max_edge_weight", &Params::max_edge_weight)
        .range(1, 1e9)
        .doc("total weight of all pairs of an edge, in pairs; none: every pair counts");
  }

  static void describe_constraints(Declaration<SolvePoseGraph>& is) {
    is.param("odometry_translation_sigma", &Params::odometry_translation_sigma)
        .unit("m")
        .range(1e-6, 1e6)
        .doc(
            "standard deviation of the translation between consecutive segments in the initial "
            "poses; none: no prior");
    is.param("odometry_rotation_sigma", &Params::odometry_rotation_sigma)
        .unit("rad")
        .range(1e-6 * deg, 360 * deg)
        .doc(
            "standard deviation of the rotation between consecutive segments in the initial poses; "
            "none: no prior");
    is.choice(
          "constraint_error", &Params::constraint_error,
          {{"g2o", ConstraintError::g2o, "[t; q.vec] of the residual pose, as in g2o"},
           {"chordal", ConstraintError::chordal, "difference of rotation matrices, as in SE-Sync"}})
        .doc("error function of a relative pose");
    is.param("constraint_scale", &Params::constraint_scale)
        .range(0.01, 1e6)
        .doc(
            "standard deviations at which the loss begins to down-weight a constraint that is not "
            "sequential");
  }

  static void describe_uncertainty(Declaration<SolvePoseGraph>& is) {
    is.param("estimate_variance", &Params::estimate_variance)
        .doc(
            "weight edges relative to sequential constraints by their mutual disagreement "
            "(variance component estimation) instead of by 'scale' alone");
    is.param("uncertainty", &Params::uncertainty)
        .doc("compute the marginal covariances of the poses; 3-D only");
    is.param("uncertainty_per_metre", &Params::uncertainty_per_metre)
        .unit("%")
        .range(0, 1)
        .doc(
            "standard deviation added to a position, as a share of its distance from the first: a "
            "bias common to all registrations causes no disagreement");
    is.param("uncertainty_factor", &Params::uncertainty_factor)
        .range(0.01, 1000)
        .doc(
            "factor on the standard deviations, since edges that share a segment share its errors");
  }

  /// One graph of all; those that hold nothing say nothing of the plane.
  static Constraints joined(const Several<Constraints>& several) {
    Constraints all;
    const Labelled<Constraints>* first = nullptr;
    for (const auto& one : several) {
      const Constraints& r = *one.value;
      if (r.relative.empty() && r.absolute.empty() && r.points.empty()) continue;
      if (first && r.planar != all.planar)
        throw Error("constraints '" + (r.planar ? one : *first).label + "' lie in the plane and '" +
                    (r.planar ? *first : one).label + "' do not; they cannot be solved together");
      if (!first) all.planar = r.planar;
      first = first ? first : &one;
      all.relative.insert(all.relative.end(), r.relative.begin(), r.relative.end());
      all.absolute.insert(all.absolute.end(), r.absolute.begin(), r.absolute.end());
      all.points.insert(all.points.end(), r.points.begin(), r.points.end());
    }
    return all;
  }
};

}  // namespace
}  // namespace plumb::solve_pose_graph

PLUMB_MODULE(plumb::solve_pose_graph::SolvePoseGraph)
