#include <numbers>

#include "fpfh.hpp"
#include "key_points.hpp"
#include "plumb/data/error.hpp"
#include "plumb/plugin/module.hpp"

namespace plumb {
namespace {

struct DescribeFpfh : SegmentStep {
  struct In {
    One<Segment> segment;
    One<Metrics> scale;
  };
  struct Out {
    Features features;
  };
  struct Params {
    double key_point_leaf = 0.8;
    double radius = 2.5;
    std::optional<std::uint32_t> most_neighbours;
    std::uint32_t least_neighbours = 10;
    double border_angle = std::numbers::pi / 2;
  };

  static void describe(Declaration<DescribeFpfh>& is) {
    is.name("describe.fpfh").version(1);
    is.summary("Describes key points by fast point feature histograms, 33 numbers each.");
    is.source("[Rusu2009] II; [Tang2024] 2.3.2");
    is.input("segment", &In::segment, "a cloud with normals");
    is.scale(&In::scale);
    is.output("features", &Out::features, "key points with their histograms and border marks");
    is.param("key_point_leaf", &Params::key_point_leaf)
        .unit("m")
        .range(0.01, 100)
        .doc("one key point per cubic cell of this edge");
    is.param("radius", &Params::radius)
        .unit("m")
        .range(0.01, 100)
        .doc("how far the neighbourhood of a point reaches");
    is.param("most_neighbours", &Params::most_neighbours)
        .range(3, 100000)
        .doc("only so many neighbours, the nearest; none: all within the radius");
    is.param("least_neighbours", &Params::least_neighbours)
        .range(1, 100000)
        .doc("key points with fewer neighbours are left out");
    is.param("border_angle", &Params::border_angle)
        .unit("rad")
        .range(std::numbers::pi / 4, 2 * std::numbers::pi)
        .doc("a key point is at the border if no neighbour lies within a sector wider than this")
        .source("[Xiong2018]");
  }

  Out run(const In& in, const Params& params, Context& context) const {
    const Cloud& cloud = in.segment->cloud;
    if (!cloud.empty() && !cloud.has_normals())
      throw Error("describe.fpfh: the segment has no normals; put estimate.normals before it");
    Fpfh result =
        fpfh(cloud, key_points(cloud, params.key_point_leaf),
             {params.radius, params.most_neighbours, params.least_neighbours, params.border_angle},
             context);
    if (result.left_out > 0)
      context.count("key points with too few neighbours left out", result.left_out);
    return {std::move(result.features)};
  }
};

}  // namespace
}  // namespace plumb

PLUMB_MODULE(plumb::DescribeFpfh)
