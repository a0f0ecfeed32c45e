#include "plumb/slam/step.hpp"

#include "mutual.hpp"
#include "plumb/data/error.hpp"
#include "plumb/plugin/module.hpp"

namespace plumb::match_fpfh_mutual {
namespace {

/// Both ends of each pair, and whether either lies at its cloud's border.
Matches paired(const Features& of_i, const Features& of_j) {
  Matches matches;
  for (const auto& [i, j] : mutual_nearest(of_i.vectors, of_j.vectors, of_i.dimension)) {
    matches.p.push_back(of_i.points[i]);
    matches.q.push_back(of_j.points[j]);
    matches.index_p.push_back(i);
    matches.index_q.push_back(j);
    matches.weight.push_back(1);
    matches.at_border.push_back((!of_i.at_border.empty() && of_i.at_border[i]) ||
                                (!of_j.at_border.empty() && of_j.at_border[j]));
    if (of_i.normals.empty() || of_j.normals.empty()) continue;
    matches.normal_p.push_back(of_i.normals[i]);
    matches.normal_q.push_back(of_j.normals[j]);
  }
  matches.found = static_cast<std::uint32_t>(matches.size());
  return matches;
}

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
    if (of_i.dimension != of_j.dimension)
      throw Error("match.fpfh_mutual: the features have " + std::to_string(of_i.dimension) +
                  " and " + std::to_string(of_j.dimension) +
                  " numbers; describe all segments by the same step");
    return {paired(of_i, of_j)};
  }
};

}  // namespace
}  // namespace plumb::match_fpfh_mutual

PLUMB_MODULE(plumb::match_fpfh_mutual::MatchFpfhMutual)
