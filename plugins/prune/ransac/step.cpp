#include "plumb/plugin/module.hpp"
#include "ransac.hpp"

namespace plumb {
namespace {

struct Ransac : EdgeStep {
  struct In {
    One<Matches> matches;
  };
  struct Out {
    Matches matches;
  };
  struct Params {
    double max_residual = RansacOptions().max_residual;
    double confidence = RansacOptions().confidence;
    std::uint32_t most_samples = RansacOptions().most_samples;
    std::uint32_t fewest = 6;
  };

  static void describe(Declaration<Ransac>& is) {
    is.name("prune.ransac").version(1);
    is.summary("Keeps the pairs that fit the rigid motion most of them agree on.");
    is.source("[Tang2024] 2.3.2, [Fischler1981]");
    is.input("matches", &In::matches, "the pairs to look at");
    is.output("matches", &Out::matches, "those that fit the best motion");
    is.param("max_residual", &Params::max_residual)
        .unit("m")
        .range(0.001, 100)
        .doc("farthest that a pair may be apart under the motion");
    is.param("confidence", &Params::confidence)
        .unit("%")
        .range(0.5, 0.999999)
        .doc("chance to have seen the best motion, after which no more samples are drawn");
    is.param("most_samples", &Params::most_samples)
        .range(1, 1e8)
        .doc("samples of three pairs at most");
    is.param("fewest", &Params::fewest)
        .range(3, 1e6)
        .doc("fewer pairs than this are kept as they are: any three fit some motion");
  }

  Out run(const In& in, const Params& params, Context& context) const {
    const Matches& matches = *in.matches;
    if (matches.size() < params.fewest) {
      if (matches.size() > 0) context.count("edges with too few pairs to sample, kept whole", 1);
      return {matches};
    }
    const auto consensus =
        ransac(matches, {params.max_residual, params.confidence, params.most_samples},
               Random(context.seed()));
    context.count("samples drawn", consensus.samples);
    context.count("pairs dropped", matches.size() - consensus.inliers.size());
    if (consensus.inliers.empty()) context.count("edges without any motion", 1);
    return {select(matches, consensus.inliers)};
  }
};

}  // namespace
}  // namespace plumb

PLUMB_MODULE(plumb::Ransac)
