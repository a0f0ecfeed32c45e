#include "plumb/slam/step.hpp"

#include "matching.hpp"
#include "plumb/plugin/module.hpp"

namespace plumb::match_features_flann {
namespace {

struct MatchFeaturesFlann : EdgeStep {
  struct In {
    OverEdges edges;
    Ends<Features> features;
  };
  struct Out {
    Matches matches;
  };
  struct Params {
    IndexOptions index;
    std::uint32_t recall_sample = 100;
  };

  static void describe(Declaration<MatchFeaturesFlann>& is) {
    is.name("match.features_flann").version(1);
    is.summary(
        "Matches keypoints that are mutual nearest neighbours in feature space, as an index of "
        "FLANN finds them.");
    is.source("[Tang2024] 2.3.2, eq. 2; [Muja2014]; [Gonzalez1985]");
    is.input("edges", &In::edges, "pairs of segments");
    is.input("features", &In::features, "keypoints with descriptors of any length");
    is.output("matches", &Out::matches, "pairs of keypoints, independent of the poses");
    is.params(&Params::index);
    is.param("recall_sample", &Params::recall_sample)
        .range(0, 1e6)
        .doc("keypoints of each edge that are looked for exactly as well; counted, not used");
  }

  Out run(const In& in, const Params& params, Context& context) const {
    const Features &of_i = *in.features.i, &of_j = *in.features.j;
    if (of_i.vectors.empty() || of_j.vectors.empty()) return {};
    feature_space::require_one_dimension(of_i, of_j);
    const Matching found = match(of_i.vectors, of_j.vectors, of_i.dimension, params.index,
                                 params.recall_sample, context.seed());
    context.count("keypoints looked for exactly as well", found.sampled);
    context.count("of these found as near by the index", found.exact);
    return {feature_space::paired(of_i, of_j, found.pairs)};
  }
};

}  // namespace
}  // namespace plumb::match_features_flann

PLUMB_MODULE(plumb::match_features_flann::MatchFeaturesFlann)
