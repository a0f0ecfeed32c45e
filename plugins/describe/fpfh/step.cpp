
#include "plumb/slam/step.hpp"

#include <optional>

#include "fpfh.hpp"
#include "plumb/data/error.hpp"
#include "plumb/plugin/module.hpp"
#include "shared/keypoints/nearest_points.hpp"
#include "shared/keypoints/one_per_voxel.hpp"

namespace plumb::describe_fpfh {
namespace {

struct DescribeFpfh : SegmentStep {
  struct In {
    One<Segment> segment, keypoints;
    One<Metrics> scale;
  };
  struct Out {
    Features features;
  };
  struct Params {
    std::optional<double> keypoint_voxel_size = 0.8;
    double radius = 2.5;
    std::optional<std::uint32_t> max_neighbours;
    std::uint32_t min_neighbours = 10;
    double border_angle = 90 * deg;
  };

  static void describe(Declaration<DescribeFpfh>& is) {
    is.name("describe.fpfh").version(1);
    is.summary(
        "Computes FPFH descriptors (fast point feature histograms, 33 numbers) at keypoints.");
    is.source("[Rusu2009] II; [Tang2024] 2.3.2; the keypoints are ours");
    is.input("segment", &In::segment, "a cloud with normals");
    is.optional_input("keypoints", &In::keypoints,
                      "keypoints of the segment instead of one a voxel, as keypoints.iss gives");
    is.scale(&In::scale);
    is.output("features", &Out::features, "keypoints with their histograms and border marks");
    is.param("keypoint_voxel_size", &Params::keypoint_voxel_size)
        .unit("m")
        .range(0.01, 100)
        .doc(
            "edge length of the voxels; each has one keypoint, unless keypoints are wired; none: "
            "every point is one, as in [Tang2024]");
    is.param("radius", &Params::radius)
        .unit("m")
        .range(0.01, 100)
        .doc("radius of a point's neighbourhood");
    is.param("max_neighbours", &Params::max_neighbours)
        .range(3, 100000)
        .doc("only this many nearest neighbours are used; none: all within the radius");
    is.param("min_neighbours", &Params::min_neighbours)
        .range(1, 100000)
        .doc("keypoints with fewer neighbours are dropped");
    is.param("border_angle", &Params::border_angle)
        .unit("rad")
        .range(45 * deg, 360 * deg)
        .doc(
            "a keypoint is at the border if its neighbours leave a sector free that is wider than "
            "this")
        .source("PCL, BoundaryEstimation");
  }

  Out run(const In& in, const Params& params, Context& context) const {
    const Cloud& cloud = in.segment->cloud;
    if (!cloud.empty() && !cloud.has_normals())
      throw Error("describe.fpfh: the segment has no normals; put estimate.normals before it");
    const auto keys =
        in.keypoints ? keypoints::nearest_points(in.segment->tree(), in.keypoints->cloud)
        : params.keypoint_voxel_size ? keypoints::one_per_voxel(cloud, *params.keypoint_voxel_size)
                                     : keypoints::all_points(cloud);
    Fpfh result =
        fpfh(cloud, keys,
             {params.radius, params.max_neighbours, params.min_neighbours, params.border_angle},
             context);
    if (result.left_out > 0)
      context.count("keypoints with too few neighbours left out", result.left_out);
    return {std::move(result.features)};
  }
};

}  // namespace
}  // namespace plumb::describe_fpfh

PLUMB_MODULE(plumb::describe_fpfh::DescribeFpfh)
