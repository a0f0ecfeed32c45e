#include "plumb/slam/step.hpp"

#include "consistency.hpp"
#include "plumb/plugin/module.hpp"

namespace plumb::prune_consistency {
namespace {

struct PruneConsistency : EdgeStep {
  struct In {
    One<Matches> matches;
    One<Metrics> scale;
  };
  struct Out {
    Matches matches;
  };
  struct Params {
    ConsistencyOptions pairs;
    std::uint32_t min_pairs = 6;
  };

  static void describe(Declaration<PruneConsistency>& is) {
    is.name("prune.consistency").version(1);
    is.summary("Keeps the pairs of the motion that a largest set of compatible pairs agrees on.");
    is.source("[Yang2021], [Shi2021], [Yang2020]");
    is.input("matches", &In::matches, "the pairs to test");
    is.scale(&In::scale);
    is.output("matches", &Out::matches, "the inliers of the motion");
    is.params(&Params::pairs);
    is.param("min_pairs", &Params::min_pairs)
        .range(3, 1e6)
        .doc("fewer pairs than this are kept as they are: any three fit some motion");
  }

  Out run(const In& in, const Params& params, Context& context) const {
    const Matches& matches = *in.matches;
    if (matches.size() < params.min_pairs) {
      if (matches.size() > 0) context.count("edges with too few pairs to compare, kept whole", 1);
      return {matches};
    }
    const Consistent found = consistent_pairs(matches, params.pairs);
    context.count("pairs dropped", matches.size() - found.inliers.size());
    if (found.inliers.empty()) context.count("edges without any motion", 1);
    if (!found.largest) context.count("edges whose clique is perhaps not a largest one", 1);
    return {select(matches, found.inliers)};
  }
};

}  // namespace
}  // namespace plumb::prune_consistency

PLUMB_MODULE(plumb::prune_consistency::PruneConsistency)
