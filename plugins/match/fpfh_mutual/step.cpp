#include "plumb/slam/step.hpp"

#include "mutual.hpp"
#include "plumb/plugin/module.hpp"
#include "shared/feature_space/paired.hpp"

namespace plumb::match_fpfh_mutual {
namespace {

struct MatchFpfhMutual : EdgeStep {
  struct In {
    OverEdges edges;
    Ends<Features> features;
  };
  struct Out {
    Matches matches;
  };
  struct Params {};

  static void describe(Declaration<MatchFpfhMutual>& is) {
    is.name("match.fpfh_mutual").version(1);
    is.summary(
        "Matches keypoints of two segments that are mutual nearest neighbours in feature space.");
    is.source("[Tang2024] 2.3.2, eq. 2");
    is.input("edges", &In::edges, "pairs of segments");
    is.input("features", &In::features, "keypoints with descriptors");
    is.output("matches", &Out::matches, "pairs of keypoints, independent of the poses");
  }

  Out run(const In& in, const Params&, Context&) const {
    const Features &of_i = *in.features.i, &of_j = *in.features.j;
    if (of_i.size() == 0 || of_j.size() == 0) return {};
    feature_space::require_one_dimension(of_i, of_j);
    return {feature_space::paired(of_i, of_j,
                                  mutual_nearest(of_i.vectors, of_j.vectors, of_i.dimension))};
  }
};

}  // namespace
}  // namespace plumb::match_fpfh_mutual

PLUMB_MODULE(plumb::match_fpfh_mutual::MatchFpfhMutual)
