#include "plumb/slam/step.hpp"

#include "plumb/plugin/module.hpp"
#include "plumb/slam/range.hpp"

namespace plumb::segment_poses {
namespace {

struct SegmentPoses : WholeStep {
  struct In {
    One<Trajectory> trajectory;
    Each<FrameRange> ranges;
  };
  struct Out {
    Poses poses;
  };
  struct Params {};

  static void describe(Declaration<SegmentPoses>& is) {
    is.name("segment.poses").version(1).source("ours");
    is.summary(
        "Evaluates a trajectory at segments that were cut from another trajectory of the same "
        "frames.");
    is.input("trajectory", &In::trajectory, "the poses of all frames");
    is.input("ranges", &In::ranges, "the frames of each segment");
    is.output("poses", &Out::poses,
              "the pose of each segment's middle frame, which is the origin of the segment's "
              "coordinates");
  }

  Out run(const In& in, const Params&, Context& context) const {
    return {poses_of(in.ranges.all(context), *in.trajectory)};
  }
};

}  // namespace
}  // namespace plumb::segment_poses

PLUMB_MODULE(plumb::segment_poses::SegmentPoses)
