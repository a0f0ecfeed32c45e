#include "plumb/slam/step.hpp"

#include <optional>

#include "by_count.hpp"
#include "plumb/plugin/module.hpp"
#include "plumb/slam/range.hpp"

namespace plumb::segment_by_count {
namespace {

struct ByCount : WholeStep {
  struct In {
    One<Trajectory> trajectory;
  };
  struct Out {
    std::vector<FrameRange> ranges;
    Poses poses;
  };
  struct Params {
    std::uint32_t frames = 60;
    std::optional<std::uint32_t> segments;
    double phase = 0;
  };

  static void describe(Declaration<ByCount>& is) {
    is.name("segment.by_count").version(1).source("[Tang2024] 2.2");
    is.summary("Cuts the trajectory into segments of an equal number of frames.");
    is.input("trajectory", &In::trajectory, "the poses of all frames");
    is.output("ranges", &Out::ranges, "the frames of each segment");
    is.output("poses", &Out::poses, "pose of each segment: that of its middle frame");
    is.param("frames", &Params::frames)
        .range(1, 65535)
        .doc("frames per segment, where 'segments' is not given")
        .source("[Tang2024] 3.1");
    is.param("segments", &Params::segments)
        .range(1, 1e9)
        .doc(
            "about so many segments: the frames of each follow from the number of all frames, "
            "rounded up; none: 'frames' each")
        .source("[Tang2024] 2.2, without a rule");
    is.param("phase", &Params::phase)
        .unit("%")
        .range(0, 0.5)
        .doc("share of 'frames' that the first segment has fewer, which moves all cuts");
  }

  Out run(const In& in, const Params& params, Context&) const {
    Out out;
    const std::size_t all = in.trajectory->size();
    const std::size_t each = params.segments ? frames_for(all, *params.segments) : params.frames;
    out.ranges = ranges_from(*in.trajectory, starts_by_count(all, each, params.phase));
    out.poses = poses_of(out.ranges);
    return out;
  }
};

}  // namespace
}  // namespace plumb::segment_by_count

PLUMB_MODULE(plumb::segment_by_count::ByCount)
