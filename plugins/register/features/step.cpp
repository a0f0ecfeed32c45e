#include "consensus.hpp"
#include "plumb/plugin/module.hpp"
#include "refine.hpp"

namespace plumb {
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
    double first_distance = 2;
    double max_distance = 0.5;
    std::uint32_t max_points = 2000;
    std::uint32_t max_pairs = 1500;
    std::uint32_t independent = 50;
  };

  static void describe(Declaration<RegisterFeatures>& is) {
    is.name("register.features").version(1);
    is.summary(
        "Registers two segments wherever they are: by the motion that feature matches agree on, "
        "then by their clouds.");
    is.source("[Chen2022] SC2-PCR for the agreement; [Chen1992] point-to-plane ICP");
    is.input("matches", &In::matches, "pairs of key points, most of which may be wrong");
    is.input("segments", &In::segments, "the clouds, with normals");
    is.scale(&In::scale);
    is.output("registration", &Out::registration,
              "the motion, its information, and whether it is accepted");
    is.param("tolerance", &Params::tolerance)
        .unit("m")
        .range(0.001, 100)
        .doc(
            "lengths between the points of two right pairs differ by at most this, and a right "
            "pair is at most so far apart");
    is.param("min_inliers", &Params::min_inliers)
        .range(3, 1e6)
        .doc("pairs that must agree on one motion");
    is.param("min_overlap", &Params::min_overlap)
        .unit("%")
        .range(0, 1)
        .doc(
            "share of the points in the common box that must lie on a surface of the other cloud, "
            "after alignment");
    is.param("first_distance", &Params::first_distance)
        .unit("m")
        .range(0.001, 100)
        .doc(
            "ICP: farthest that two points of a correspondence may be apart, in the first "
            "iteration");
    is.param("max_distance", &Params::max_distance)
        .unit("m")
        .range(0.001, 100)
        .doc("the same in the last iterations, and for the overlap");
    is.param("max_points", &Params::max_points)
        .range(30, 1e9)
        .doc("points of a cloud that are asked, evenly chosen");
    is.param("max_pairs", &Params::max_pairs)
        .range(3, 20000)
        .doc("matches that are looked at, evenly chosen; the time goes with the square");
    is.param("independent", &Params::independent)
        .range(1, 1e9)
        .doc("the correspondences count as so many independent ones in the information");
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
                             {params.first_distance, params.max_distance, 20, params.max_points},
                             params.independent);
    r.accepted = r.overlap >= params.min_overlap && !r.information.isZero(0);
    context.count(r.accepted ? "edges registered"
                             : "edges whose clouds do not overlap enough after alignment",
                  1);
    return {r};
  }
};

}  // namespace
}  // namespace plumb

PLUMB_MODULE(plumb::RegisterFeatures)
