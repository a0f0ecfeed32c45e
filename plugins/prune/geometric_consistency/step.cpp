#include "plumb/slam/step.hpp"

#include "consistent.hpp"
#include "plumb/plugin/module.hpp"

namespace plumb::prune_geometric_consistency {
namespace {

struct GeometricConsistency : EdgeStep {
  struct In {
    One<Matches> matches;
    Relative poses;
    One<Metrics> scale;
  };
  struct Out {
    Matches matches;
  };
  struct Params {
    ConsistencyOptions consistency;
  };

  static void describe(Declaration<GeometricConsistency>& is) {
    is.name("prune.geometric_consistency").version(1);
    is.summary("Keeps the largest set of pairs that keep the lengths between each other.");
    is.source("[Chen2007]; PCL, GeometricConsistencyGrouping");
    is.input("matches", &In::matches, "the pairs to test");
    is.optional_input("poses", &In::poses,
                      "the current poses: sets begin with the pairs that lie closest under them");
    is.scale(&In::scale);
    is.output("matches", &Out::matches, "the pairs of one set");
    is.params(&Params::consistency);
  }

  Out run(const In& in, const Params& params, Context& context) const {
    const Matches& matches = *in.matches;
    if (matches.size() < params.consistency.gc_threshold) {
      if (matches.size() > 0) context.count("edges with too few pairs to group, kept whole", 1);
      return {matches};
    }
    const auto T_i_j = in.poses ? std::optional(in.poses.T_i_j) : std::nullopt;
    const auto kept = largest_consistent(matches, T_i_j, params.consistency);
    context.count("pairs dropped", matches.size() - kept.size());
    if (kept.empty()) context.count("edges without a consistent set of pairs", 1);
    return {select(matches, kept)};
  }
};

}  // namespace
}  // namespace plumb::prune_geometric_consistency

PLUMB_MODULE(plumb::prune_geometric_consistency::GeometricConsistency)
