#include "closer.hpp"
#include "plumb/plugin/module.hpp"

namespace plumb {
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
    double max = 3;
    std::optional<double> loop_margin;
  };

  static void describe(Declaration<DistanceGate>& is) {
    is.name("prune.distance").version(1);
    is.summary("Keeps the pairs that lie near each other under the present poses.");
    is.source("[Tang2024] 2.3.2, 2.4.1");
    is.input("matches", &In::matches, "the pairs to look at");
    is.input("poses", &In::poses, "where the segments are at present");
    is.optional_input("edges", &In::edges, "kinds and centroid distances; for 'loop_margin'");
    is.scale(&In::scale);
    is.output("matches", &Out::matches, "the pairs within the gate");
    is.param("max", &Params::max)
        .unit("m")
        .range(0.01, 1000)
        .doc("farthest that a pair may be apart");
    is.param("loop_margin", &Params::loop_margin)
        .unit("m")
        .range(0, 1000)
        .doc(
            "on loop edges the gate is the distance of the centroids plus this; none: 'max' there "
            "too");
  }

  Out run(const In& in, const Params& params, Context& context) const {
    if (params.loop_margin && !in.edges)
      throw Error(
          "'loop_margin' is set but the input 'edges' is not wired: wire the edges that the "
          "pairs belong to, or leave 'loop_margin' out");
    double gate = params.max;
    if (params.loop_margin && in.edges.edge.kind == EdgeKind::loop)
      gate = in.edges.edge.centroid_distance + *params.loop_margin;
    const auto kept = closer(*in.matches, in.poses.T_i_j, gate);
    context.count("pairs dropped", in.matches->size() - kept.size());
    return {select(*in.matches, kept)};
  }
};

}  // namespace
}  // namespace plumb

PLUMB_MODULE(plumb::DistanceGate)
