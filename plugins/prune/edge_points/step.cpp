#include "plumb/slam/step.hpp"

#include <optional>

#include "inner.hpp"
#include "plumb/plugin/module.hpp"

namespace plumb::prune_edge_points {
namespace {

struct EdgePoints : EdgeStep {
  struct In {
    One<Matches> matches;
    Ends<Features> features;
  };
  struct Out {
    Matches matches;
  };
  struct Params {
    std::optional<double> distance;
  };

  static void describe(Declaration<EdgePoints>& is) {
    is.name("prune.edge_points").version(1);
    is.summary("Removes pairs with a point at the border of its cloud.");
    is.source("[Tang2024] 2.3.2, [Xiong2018]");
    is.input("matches", &In::matches, "pairs, with border marks where no 'distance' is given");
    is.optional_input("features", &In::features,
                      "the features that were matched, with border marks; for 'distance'");
    is.output("matches", &Out::matches, "the pairs with both points inside");
    is.param("distance", &Params::distance)
        .unit("m")
        .range(0, 100)
        .doc(
            "pairs with a point this close to an edge point of its cloud, a keypoint at the "
            "border, are dropped; none: those with a point that is one itself")
        .source("[Tang2024] 2.3.2, without a number");
  }

  Out run(const In& in, const Params& params, Context& context) const {
    if (params.distance && !in.features)
      throw Error(
          "'distance' is set but the input 'features' is not wired: wire the features that the "
          "pairs were matched by, or leave 'distance' out");
    const auto kept = params.distance
                          ? inner(*in.matches, *in.features.i, *in.features.j, *params.distance)
                          : inner(*in.matches);
    context.count("pairs at a border dropped", in.matches->size() - kept.size());
    return {select(*in.matches, kept)};
  }
};

}  // namespace
}  // namespace plumb::prune_edge_points

PLUMB_MODULE(plumb::prune_edge_points::EdgePoints)
