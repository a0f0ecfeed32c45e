#include "plumb/plugin/module.hpp"
#include "pose_graph.hpp"

namespace plumb {
namespace {

const std::vector<ChoiceOf<Loss>> losses = {
    {"none", Loss::none, "least squares"},
    {"huber", Loss::huber,
     "weight 1, beyond the scale falling with 1 / r: large residuals still pull"},
    {"cauchy", Loss::cauchy, "weight falling with 1 / r^2"},
    {"geman_mcclure", Loss::geman_mcclure,
     "weight falling with 1 / r^4: lets go of what is wrong"}};

struct SolvePoseGraph : WholeStep {
  struct In {
    One<Poses> poses;
    Each<Matches> matches;
    Several<Relations> relations;
    One<Metrics> scale;
  };
  struct Out {
    Poses poses;
    Metrics metrics;
    Relations uncertainty;
  };
  using Params = GraphOptions;

  static void describe(Declaration<SolvePoseGraph>& is) {
    is.name("solve.pose_graph")
        .version(2)
        .summary("Moves all segments so that the pairs of all edges come together.")
        .source("[Tang2024] 2.1, 2.4.1");
    is.input("poses", &In::poses, "where the segments are; the solver starts here");
    is.optional_input("matches", &In::matches, "point pairs of each edge");
    is.optional_input("relations", &In::relations,
                      "measured relative and absolute poses and points; several are joined");
    is.scale(&In::scale);
    is.output("poses", &Out::poses, "where the segments are after solving");
    is.output("metrics", &Out::metrics, "cost, residual, and what became of each edge");
    is.output("uncertainty", &Out::uncertainty,
              "with 'uncertainty: true', how well each pose is known beside the first: absolute "
              "poses with their information");
    is.choice("loss", &Params::loss, losses)
        .doc("how a pair's squared residual counts")
        .source("[Tang2024] 2.1");
    is.param("scale", &Params::scale)
        .unit("m")
        .range(1e-4, 1000)
        .doc(
            "residual of a pair at which the loss begins to let go; also a pair's standard "
            "deviation beside relations and odometry");
    is.param("anneal_from", &Params::anneal_from)
        .unit("m")
        .range(1e-4, 1e6)
        .doc(
            "scale of the first round, shrinking geometrically to 'scale': lets wrong edges go one "
            "by one");
    is.param("hold_sequential", &Params::hold_sequential)
        .doc(
            "sequential edges keep pulling: with cauchy and geman_mcclure their pairs take huber "
            "instead");
    is.choice("edge_loss", &Params::edge_loss, losses)
        .doc("how the rms of an edge that is not sequential counts, on top of its pairs' losses");
    is.param("edge_scale", &Params::edge_scale)
        .unit("m")
        .range(1e-4, 1000)
        .doc("rms of an edge's pairs at which edge_loss begins to let go; annealed like 'scale'");
    is.param("edge_weight", &Params::edge_weight)
        .range(1, 1e9)
        .doc(
            "the most that all pairs of an edge weigh together, in pairs; none: every pair counts");
    is.param("odometry_translation", &Params::odometry_translation)
        .unit("m")
        .range(1e-6, 1e6)
        .doc(
            "standard deviation of the way from each segment to the next, as the poses come; none: "
            "free");
    is.param("odometry_rotation", &Params::odometry_rotation)
        .unit("rad")
        .range(1e-8, 10)
        .doc(
            "standard deviation of the turn from each segment to the next, as the poses come; "
            "none: free");
    is.choice("relation_error", &Params::relation_error,
              {{"g2o", RelationError::g2o, "[t; q.vec] of what is left, as g2o has it"},
               {"chordal", RelationError::chordal,
                "difference of rotation matrices, as SE-Sync has it"}})
        .doc("how a relation is compared with the poses");
    is.param("relation_scale", &Params::relation_scale)
        .range(0.01, 1e6)
        .doc(
            "standard deviations at which the loss begins to let go of a relation that is not "
            "sequential");
    is.param("rounds", &Params::rounds)
        .range(1, 1000)
        .doc(
            "the most times that weights are refreshed; with anneal_from two thirds of them shrink "
            "the scale");
    is.param("iterations", &Params::iterations)
        .range(1, 10000)
        .doc("the most iterations of Levenberg-Marquardt in one round");
    is.param("estimate_variance", &Params::estimate_variance)
        .doc(
            "edges count, beside sequential relations, by how far they disagree with each other "
            "instead of by 'scale' alone");
    is.param("uncertainty", &Params::uncertainty)
        .doc("compute how well each pose is known; only in space");
    is.param("uncertainty_per_metre", &Params::uncertainty_per_metre)
        .unit("%")
        .range(0, 1)
        .doc(
            "standard deviation of a position, of its distance from the first, on top: a bias that "
            "all registrations share shows in no disagreement");
    is.param("uncertainty_factor", &Params::uncertainty_factor)
        .range(0.01, 1000)
        .doc(
            "standard deviations are multiplied by it, since edges that share a segment share its "
            "errors");
    is.param("tolerance", &Params::tolerance)
        .unit("m")
        .range(0, 1)
        .doc("rounds end when no pose moves more than this, a rotation counting at 10 m");
  }

  Out run(const In& in, const Params& params, Context& context) const {
    if (!in.matches && in.relations.empty())
      throw Error("solve.pose_graph has nothing to solve: wire 'matches', 'relations' or both");
    std::vector<One<Matches>> held;
    std::vector<MatchedEdge> edges;
    if (in.matches) {
      held.resize(in.matches.size());
      context.parallel(held.size(), [&](std::size_t k) { held[k] = in.matches.open(k); });
      for (std::size_t k = 0; k < held.size(); ++k)
        edges.push_back({in.matches.edges().list[k], &*held[k]});
    }
    const Relations relations = joined(in.relations);
    auto result =
        solve_pose_graph(*in.poses, edges, in.relations.empty() ? nullptr : &relations, params,
                         [&](std::size_t n, const auto& body) { context.parallel(n, body); });
    for (const auto& warning : result.warnings) context.warn(warning);
    return {std::move(result.poses), std::move(result.metrics), std::move(result.uncertainty)};
  }

 private:
  /// One graph of all; those that hold nothing say nothing of the plane.
  static Relations joined(const Several<Relations>& several) {
    Relations all;
    const Labelled<Relations>* first = nullptr;
    for (const auto& one : several) {
      const Relations& r = *one.value;
      if (r.relative.empty() && r.absolute.empty() && r.points.empty()) continue;
      if (first && r.planar != all.planar)
        throw Error("relations '" + (r.planar ? one : *first).label + "' lie in the plane and '" +
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
}  // namespace plumb

PLUMB_MODULE(plumb::SolvePoseGraph)
