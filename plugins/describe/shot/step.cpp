#include "plumb/slam/step.hpp"

#include "plumb/plugin/module.hpp"
#include "shared/keypoints/nearest_points.hpp"
#include "shared/keypoints/one_per_voxel.hpp"
#include "shot.hpp"

namespace plumb::describe_shot {
namespace {

struct DescribeShot : SegmentStep {
  struct In {
    One<Segment> segment, keypoints;
    One<Metrics> scale;
  };
  struct Out {
    Features features;
  };
  struct Params {
    double keypoint_voxel_size = 0.8;
    ShotOptions shot;
  };

  static void describe(Declaration<DescribeShot>& is) {
    is.name("describe.shot").version(1).source("[Tombari2010]; PCL, SHOTEstimation");
    is.summary(
        "Computes SHOT descriptors (signatures of histograms of orientations, 352 numbers) at "
        "keypoints.");
    is.input("segment", &In::segment, "a cloud with normals");
    is.optional_input("keypoints", &In::keypoints,
                      "keypoints of the segment instead of one a voxel, as keypoints.iss gives");
    is.scale(&In::scale);
    is.output("features", &Out::features, "keypoints with their signatures and border marks");
    is.param("keypoint_voxel_size", &Params::keypoint_voxel_size)
        .unit("m")
        .range(0.01, 100)
        .doc("edge length of the voxels; each has one keypoint, unless keypoints are wired");
    is.params(&Params::shot);
  }

  Out run(const In& in, const Params& params, Context& context) const {
    const Segment& segment = *in.segment;
    Shot result =
        shot(segment.cloud,
             in.keypoints ? keypoints::nearest_points(segment.tree(), in.keypoints->cloud)
                          : keypoints::one_per_voxel(segment.cloud, params.keypoint_voxel_size),
             params.shot);
    if (result.left_out > 0)
      context.count("keypoints without a local reference frame left out", result.left_out);
    return {std::move(result.features)};
  }
};

}  // namespace
}  // namespace plumb::describe_shot

PLUMB_MODULE(plumb::describe_shot::DescribeShot)
