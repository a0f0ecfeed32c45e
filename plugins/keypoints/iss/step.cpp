#include "plumb/slam/step.hpp"

#include "iss.hpp"
#include "plumb/plugin/module.hpp"

namespace plumb::keypoints_iss {
namespace {

struct KeypointsIss : SegmentStep {
  struct In {
    One<Segment> segment;
    One<Metrics> scale;
  };
  struct Out {
    Segment keypoints;
  };
  struct Params {
    IssOptions iss;
  };

  static void describe(Declaration<KeypointsIss>& is) {
    is.name("keypoints.iss").version(1).source("[Zhong2009]; PCL, ISSKeypoint3D");
    is.summary(
        "Keeps the points where the surface varies most in all three directions: ISS (intrinsic "
        "shape signatures).");
    is.input("segment", &In::segment, "the cloud to choose from");
    is.scale(&In::scale);
    is.output("keypoints", &Out::keypoints, "those of its points that are keypoints");
    is.params(&Params::iss);
  }

  Out run(const In& in, const Params& params, Context& context) const {
    const auto kept = iss(in.segment->cloud, params.iss);
    context.count("keypoints", kept.size());
    return {in.segment->selected(kept)};
  }
};

}  // namespace
}  // namespace plumb::keypoints_iss

PLUMB_MODULE(plumb::keypoints_iss::KeypointsIss)
