#include "plumb/slam/step.hpp"

#include "plumb/plugin/module.hpp"
#include "shared/point_pairs/rigid_fit.hpp"

namespace plumb::prune_distance {
namespace {

struct DistanceGate : EdgeStep {
  struct In {
    One<Matches> matches;
    Relative poses;
    ThisEdge edges;
    One<Metrics> scale;
  };
  struct Out {
    Matches matches;
  };
  struct Params {
    double max_correspondence_distance = 3;
    std::optional<double> loop_margin;
  };

  static void describe(Declaration<DistanceGate>& is) {
    is.name("prune.distance").version(1);
    is.summary("Keeps the pairs whose points lie close to each other under the current poses.");
    is.source("[Tang2024] 2.3.2, 2.4.1");
    is.input("matches", &In::matches, "the pairs to test");
    is.input("poses", &In::poses, "the current poses of the segments");
    is.optional_input("edges", &In::edges, "kinds and centroid distances; for 'loop_margin'");
    is.scale(&In::scale);
    is.output("matches", &Out::matches, "the pairs within the distance");
    is.param("max_correspondence_distance", &Params::max_correspondence_distance)
        .unit("m")
        .range(0.01, 1000)
        .doc("distance between the two points of a pair");
    is.param("loop_margin", &Params::loop_margin)
        .unit("m")
        .range(0, 1000)
        .doc(
            "on loop edges the bound is the distance of the centroids plus this; none: "
            "'max_correspondence_distance' there too");
  }

  Out run(const In& in, const Params& params, Context& context) const {
    if (params.loop_margin && !in.edges)
      throw Error(
          "'loop_margin' is set but the input 'edges' is not wired: wire the edges that the "
          "pairs belong to, or leave 'loop_margin' out");
    double gate = params.max_correspondence_distance;
    if (params.loop_margin && in.edges.edge.kind == EdgeKind::loop)
      gate = in.edges.edge.centroid_distance + *params.loop_margin;
    const auto kept = point_pairs::agreeing(in.matches->q, in.matches->p, in.poses.T_i_j, gate);
    context.count("pairs dropped", in.matches->size() - kept.size());
    return {select(*in.matches, kept)};
  }
};

}  // namespace
}  // namespace plumb::prune_distance

PLUMB_MODULE(plumb::prune_distance::DistanceGate)
