#include "plumb/slam/step.hpp"

#include "plumb/plugin/module.hpp"
#include "ransac.hpp"

namespace plumb::prune_ransac {
namespace {

struct Ransac : EdgeStep {
  struct In {
    One<Matches> matches;
  };
  struct Out {
    Matches matches;
  };
  struct Params {
    double max_correspondence_distance = RansacOptions().max_correspondence_distance;
    double confidence = RansacOptions().confidence;
    std::uint32_t max_iterations = RansacOptions().max_iterations;
    std::uint32_t min_pairs = 6;
    std::uint32_t seed = 0;
  };

  static void describe(Declaration<Ransac>& is) {
    is.name("prune.ransac").version(1);
    is.summary("Keeps the inliers of the rigid motion that RANSAC finds.");
    is.source("[Tang2024] 2.3.2, [Fischler1981]");
    is.input("matches", &In::matches, "the pairs to test");
    is.output("matches", &Out::matches, "the inliers of the best motion");
    is.param("max_correspondence_distance", &Params::max_correspondence_distance)
        .unit("m")
        .range(0.001, 100)
        .doc("distance between the two points of an inlier under the motion");
    is.param("confidence", &Params::confidence)
        .unit("%")
        .range(0.5, 0.999999)
        .doc("probability that the best motion was sampled, at which sampling stops");
    is.param("max_iterations", &Params::max_iterations).range(1, 1e8).doc("samples of three pairs");
    is.param("min_pairs", &Params::min_pairs)
        .range(3, 1e6)
        .doc("fewer pairs than this are kept as they are: any three fit some motion");
    is.param("seed", &Params::seed).doc("another draw for each number; 0: by the inputs alone");
  }

  Out run(const In& in, const Params& params, Context& context) const {
    const Matches& matches = *in.matches;
    if (matches.size() < params.min_pairs) {
      if (matches.size() > 0) context.count("edges with too few pairs to sample, kept whole", 1);
      return {matches};
    }
    const auto consensus = ransac(
        matches, {params.max_correspondence_distance, params.confidence, params.max_iterations},
        Random(reseeded(context.seed(), params.seed)));
    context.count("samples drawn", consensus.samples);
    context.count("pairs dropped", matches.size() - consensus.inliers.size());
    if (consensus.inliers.empty()) context.count("edges without any motion", 1);
    return {select(matches, consensus.inliers)};
  }
};

}  // namespace
}  // namespace plumb::prune_ransac

PLUMB_MODULE(plumb::prune_ransac::Ransac)
