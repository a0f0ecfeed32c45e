#include "plumb/slam/step.hpp"

#include "consensus.hpp"
#include "plumb/plugin/module.hpp"
#include "refine.hpp"

namespace plumb::register_features {
namespace {

struct RegisterFeatures : EdgeStep {
  struct In {
    One<Matches> matches;
    Ends<Segment> segments;
    One<Metrics> scale;
  };
  struct Out {
    Registration registration;
  };
  struct Params {
    double tolerance = 0.6;
    std::uint32_t min_inliers = 12;
    double min_overlap = 0.25;
    double initial_max_correspondence_distance = 2;
    double max_correspondence_distance = 0.5;
    std::uint32_t max_points = 2000;
    std::uint32_t max_pairs = 1500;
    std::uint32_t independent = 50;
  };

  static void describe(Declaration<RegisterFeatures>& is) {
    is.name("register.features").version(1);
    is.summary(
        "Registers two segments without an initial pose, by consensus of feature matches and then "
        "ICP.");
    is.source("[Chen2022] SC2-PCR for the agreement; [Chen1992] point-to-plane ICP");
    is.input("matches", &In::matches, "pairs of keypoints, most of which may be wrong");
    is.input("segments", &In::segments, "the clouds, with normals");
    is.scale(&In::scale);
    is.output("registration", &Out::registration,
              "the motion, its information, and whether it is accepted");
    is.param("tolerance", &Params::tolerance)
        .unit("m")
        .range(0.001, 100)
        .doc(
            "correct pairs preserve the distance between their points up to this value, and are at "
            "most this far apart");
    is.param("min_inliers", &Params::min_inliers)
        .range(3, 1e6)
        .doc("pairs that must agree on one motion");
    is.param("min_overlap", &Params::min_overlap)
        .unit("%")
        .range(0, 1)
        .doc(
            "share of the points in the common box that must lie on a surface of the other cloud "
            "after alignment");
    is.param("initial_max_correspondence_distance", &Params::initial_max_correspondence_distance)
        .unit("m")
        .range(0.001, 100)
        .doc("ICP: distance between the two points of a correspondence, in the first iteration");
    is.param("max_correspondence_distance", &Params::max_correspondence_distance)
        .unit("m")
        .range(0.001, 100)
        .doc("the same in the last iterations, and for the overlap");
    is.param("max_points", &Params::max_points)
        .range(30, 1e9)
        .doc("points of a cloud that are matched, evenly selected");
    is.param("max_pairs", &Params::max_pairs)
        .range(3, 20000)
        .doc("matches that are used, evenly selected; the time grows with the square");
    is.param("independent", &Params::independent)
        .range(1, 1e9)
        .doc("number of independent correspondences that the information is computed for");
  }

  Out run(const In& in, const Params& params, Context& context) const {
    const Segment &i = *in.segments.i, &j = *in.segments.j;
    if ((!i.cloud.empty() && !i.cloud.has_normals()) ||
        (!j.cloud.empty() && !j.cloud.has_normals()))
      throw Error("the segments have no normals; put estimate.normals before it");
    const Consensus agreed =
        consensus_of(*in.matches, {params.tolerance, 6 * params.tolerance, params.max_pairs});
    if (agreed.inliers.size() < params.min_inliers) {
      context.count("edges whose matches agree on no motion", 1);
      return {};
    }
    Registration r = refined(i, j, agreed.T_j_i,
                             {params.initial_max_correspondence_distance,
                              params.max_correspondence_distance, 20, params.max_points},
                             params.independent);
    r.accepted = r.overlap >= params.min_overlap && !r.information.isZero(0);
    context.count(r.accepted ? "edges registered"
                             : "edges whose clouds do not overlap enough after alignment",
                  1);
    return {r};
  }
};

}  // namespace
}  // namespace plumb::register_features

PLUMB_MODULE(plumb::register_features::RegisterFeatures)
