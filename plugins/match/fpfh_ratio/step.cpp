#include "plumb/slam/step.hpp"

#include "plumb/plugin/module.hpp"
#include "ratio.hpp"

namespace plumb::match_fpfh_ratio {
namespace {

struct MatchFpfhRatio : EdgeStep {
  struct In {
    OverEdges edges;
    Ends<Features> features;
    One<Metrics> scale;
  };
  struct Out {
    Matches matches;
  };
  struct Params {
    RatioOptions ratio;
  };

  static void describe(Declaration<MatchFpfhRatio>& is) {
    is.name("match.fpfh_ratio").version(1);
    is.summary(
        "Matches keypoints that are nearest in feature space and much nearer than the second.");
    is.source("[Lowe2004] 7.1; of clouds, and the test both ways, ours");
    is.input("edges", &In::edges, "pairs of segments");
    is.input("features", &In::features, "keypoints with descriptors");
    is.scale(&In::scale);
    is.output("matches", &Out::matches, "pairs of keypoints, independent of the poses");
    is.params(&Params::ratio);
  }

  Out run(const In& in, const Params& params, Context&) const {
    const Features &of_i = *in.features.i, &of_j = *in.features.j;
    if (of_i.vectors.empty() || of_j.vectors.empty()) return {};
    feature_space::require_one_dimension(of_i, of_j);
    return {feature_space::paired(of_i, of_j, distinctive_pairs(of_i, of_j, params.ratio))};
  }
};

}  // namespace
}  // namespace plumb::match_fpfh_ratio

PLUMB_MODULE(plumb::match_fpfh_ratio::MatchFpfhRatio)
