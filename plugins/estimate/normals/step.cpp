#include "normals.hpp"
#include "plumb/plugin/module.hpp"

namespace plumb {
namespace {

struct EstimateNormals : SegmentStep {
  struct In {
    One<Segment> segment;
    One<Metrics> scale;
  };
  struct Out {
    Segment segment;
  };
  struct Params {
    std::optional<double> radius = 1.0;
    std::optional<std::uint32_t> neighbours = 30;
    double min_width = 1e-3;
    double max_thickness = 1;
    bool planar = false;
    std::string check() const {
      return radius || neighbours ? ""
                                  : "'radius' and 'neighbours' are both none; give one of them";
    }
  };

  static void describe(Declaration<EstimateNormals>& is) {
    is.name("estimate.normals").version(1);
    is.summary(
        "Gives every point the normal of its neighbourhood, turned to where the sensor stood.");
    is.source("[Rusu2009] II.A; turned as in [Tang2024] 2.3.2");
    is.input("segment", &In::segment, "the cloud");
    is.scale(&In::scale);
    is.output("segment", &Out::segment,
              "the same points with normals; (0, 0, 0) where there is none");
    is.param("radius", &Params::radius)
        .unit("m")
        .range(0.001, 100)
        .doc("neighbours lie within this distance; none: however far");
    is.param("neighbours", &Params::neighbours)
        .range(3, 1000)
        .doc(
            "at most so many, the nearest, the point itself included; none: all within the radius");
    is.param("min_width", &Params::min_width)
        .unit("%")
        .range(0, 1)
        .doc(
            "neighbours that are spread across by less than this share of their spread along lie "
            "on a line, which has no normal: of one scan line");
    is.param("max_thickness", &Params::max_thickness)
        .unit("%")
        .range(0, 1)
        .doc(
            "neighbours that are spread off their plane by more than this share of their spread "
            "across lie on no surface, as in a tree");
    is.param("planar", &Params::planar)
        .doc("the clouds are a 2-D laser's: normals of lines in the plane, (0, 0, 0) at corners");
  }

  Out run(const In& in, const Params& params, Context& context) const {
    const Segment& segment = *in.segment;
    Cloud cloud = segment.cloud;
    const std::size_t without = estimate_normals(
        cloud, segment.tree(),
        {params.radius, params.neighbours, params.min_width, params.max_thickness, params.planar},
        [&](std::size_t k) { return segment.origin(k); }, context);
    if (without > 0) context.count("points without a normal", without);
    return {segment.with(std::move(cloud), segment.frame)};
  }
};

}  // namespace
}  // namespace plumb

PLUMB_MODULE(plumb::EstimateNormals)
