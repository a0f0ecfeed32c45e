#include "plumb/slam/step.hpp"

#include "normals.hpp"
#include "plumb/plugin/module.hpp"

namespace plumb::estimate_normals {
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
    std::optional<std::uint32_t> max_neighbours = 30;
    double min_width = 1e-3;
    double max_thickness = 1;
    bool planar = false;
    std::string check() const {
      return radius || max_neighbours
                 ? ""
                 : "'radius' and 'max_neighbours' are both none; give one of them";
    }
  };

  static void describe(Declaration<EstimateNormals>& is) {
    is.name("estimate.normals").version(1);
    is.summary(
        "Estimates the normal of every point from its neighbourhood, oriented towards the sensor.");
    is.source("[Rusu2009] II.A; the orientation is ours");
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
        .doc(
            "only this many nearest points are used, the point itself included; none: all within "
            "the radius");
    is.param("min_width", &Params::min_width)
        .unit("%")
        .range(0, 1)
        .doc(
            "a neighbourhood whose width is less than this share of its length is a line, such as "
            "a single scan line, and has no normal");
    is.param("max_thickness", &Params::max_thickness)
        .unit("%")
        .range(0, 1)
        .doc(
            "a neighbourhood whose thickness is more than this share of its width is no surface, "
            "such as foliage, and has no normal");
    is.param("planar", &Params::planar)
        .doc(
            "the clouds come from a 2-D laser: normals of lines in the plane, (0, 0, 0) at "
            "corners");
  }

  Out run(const In& in, const Params& params, Context& context) const {
    const Segment& segment = *in.segment;
    Cloud cloud = segment.cloud;
    const std::size_t without = estimate_normals(
        cloud, segment.tree(),
        {params.radius, params.max_neighbours, params.min_width, params.max_thickness,
         params.planar},
        [&](std::size_t k) { return segment.origin(k); }, context);
    if (without > 0) context.count("points without a normal", without);
    return {segment.with(std::move(cloud), segment.frame)};
  }
};

}  // namespace
}  // namespace plumb::estimate_normals

PLUMB_MODULE(plumb::estimate_normals::EstimateNormals)
