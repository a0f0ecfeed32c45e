#include "plumb/slam/step.hpp"

#include "jet.hpp"
#include "plumb/plugin/module.hpp"

namespace plumb::estimate_normals_jet {
namespace {

struct EstimateNormalsJet : SegmentStep {
  struct In {
    One<Segment> segment;
    One<Metrics> scale;
  };
  struct Out {
    Segment segment;
  };
  struct Params {
    std::optional<double> radius = 1.0;
    std::optional<std::uint32_t> max_neighbours = 30;
    JetOptions jet;
    std::string check() const {
      return radius || max_neighbours
                 ? ""
                 : "'radius' and 'max_neighbours' are both none; give one of them";
    }
  };

  static void describe(Declaration<EstimateNormalsJet>& is) {
    is.name("estimate.normals_jet").version(1);
    is.summary(
        "Estimates the normal of every point from the curved surface that fits its neighbourhood.");
    is.source("[Cazals2005]; the orientation is ours");
    is.input("segment", &In::segment, "the cloud");
    is.scale(&In::scale);
    is.output("segment", &Out::segment,
              "the same points with normals; (0, 0, 0) where there is none");
    is.param("radius", &Params::radius)
        .unit("m")
        .range(0.001, 100)
        .doc("neighbours lie within this distance; none: no limit");
    is.param("max_neighbours", &Params::max_neighbours)
        .range(3, 1000)
        .doc("only this many nearest points are used, the point itself included; none: all");
    is.params(&Params::jet);
  }

  Out run(const In& in, const Params& params, Context& context) const {
    const Segment& segment = *in.segment;
    Cloud cloud = segment.cloud;
    const std::size_t without = jet_normals(
        cloud, segment.tree(), {params.radius, params.max_neighbours}, params.jet,
        [&](std::size_t k) { return segment.origin(k); }, context);
    if (without > 0) context.count("points without a normal", without);
    return {segment.with(std::move(cloud), segment.frame)};
  }
};

}  // namespace
}  // namespace plumb::estimate_normals_jet

PLUMB_MODULE(plumb::estimate_normals_jet::EstimateNormalsJet)
