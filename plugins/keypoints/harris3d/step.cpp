#include "plumb/slam/step.hpp"

#include "harris3d.hpp"
#include "plumb/plugin/module.hpp"

namespace plumb::keypoints_harris3d {
namespace {

struct KeypointsHarris3d : SegmentStep {
  struct In {
    One<Segment> segment;
    One<Metrics> scale;
  };
  struct Out {
    Segment keypoints;
  };
  struct Params {
    HarrisOptions harris;
  };

  static void describe(Declaration<KeypointsHarris3d>& is) {
    is.name("keypoints.harris3d").version(1).source("PCL, HarrisKeypoint3D; compare [Sipiran2011]");
    is.summary("Keeps the points where the normals look in three directions: Harris corners.");
    is.input("segment", &In::segment, "a cloud with normals");
    is.scale(&In::scale);
    is.output("keypoints", &Out::keypoints, "those of its points that are keypoints");
    is.params(&Params::harris);
  }

  Out run(const In& in, const Params& params, Context& context) const {
    const auto kept = harris3d(in.segment->cloud, params.harris);
    context.count("keypoints", kept.size());
    return {in.segment->selected(kept)};
  }
};

}  // namespace
}  // namespace plumb::keypoints_harris3d

PLUMB_MODULE(plumb::keypoints_harris3d::KeypointsHarris3d)
