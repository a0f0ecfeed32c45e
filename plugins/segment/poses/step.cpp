#include "plumb/slam/step.hpp"

#include "plumb/plugin/module.hpp"

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

  Out run(const In& in, const Params&, Context&) const {
    Out out;
    for (std::size_t k = 0; k < in.ranges.size(); ++k) {
      const auto range = in.ranges.open(k);
      if (range->end > in.trajectory->size())
        throw Error("segment " + std::to_string(k) + " has frames up to " +
                    std::to_string(range->end) + ", the trajectory only " +
                    std::to_string(in.trajectory->size()) + ": wire ranges of the same frames");
      out.poses.T_world_segment.push_back(
          in.trajectory->T_world_frame[range->first + range->size() / 2]);
    }
    return out;
  }
};

}  // namespace
}  // namespace plumb::segment_poses

PLUMB_MODULE(plumb::segment_poses::SegmentPoses)
