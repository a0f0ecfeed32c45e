#include "plumb/slam/step.hpp"

#include <algorithm>

#include "plumb/data/counted.hpp"
#include "plumb/plugin/module.hpp"
#include "refine.hpp"

namespace plumb::refine_frames {
namespace {

struct RefineFrames : WholeStep {
  struct In {
    One<Trajectory> trajectory;
    Each<Frame> frames;
    Each<Segment> segments;
    One<Poses> poses;
    One<Metrics> scale;
  };
  struct Out {
    Trajectory trajectory;
  };
  struct Params {
    std::uint32_t neighbours = 2;
    FrameOptions registration;
  };

  static void describe(Declaration<RefineFrames>& is) {
    is.name("refine.frames").version(1).source("ours; [Chen1992] point-to-plane ICP");
    is.summary(
        "Registers each frame to the neighbouring segments, which removes the odometry's error "
        "within a segment.");
    is.input("trajectory", &In::trajectory,
             "the poses of all frames, close to the segments' poses");
    is.input("frames", &In::frames, "the clouds of all frames");
    is.input("segments", &In::segments, "the frames' segments, with normals");
    is.input("poses", &In::poses, "poses of the segments, in the trajectory's world");
    is.scale(&In::scale);
    is.output("trajectory", &Out::trajectory, "the refined poses of all frames");
    is.param("neighbours", &Params::neighbours)
        .range(1, 100)
        .doc(
            "segments before, and as many after its own, that a frame is registered to; its own "
            "segment is left out, since it would keep the frame in place");
    is.params(&Params::registration);
  }

  Out run(const In& in, const Params& params, Context& context) const {
    const std::size_t count = in.segments.size();
    if (in.poses->size() != count || in.frames.size() != in.trajectory->size())
      throw Error("got " + counted(count, "segments") + ", " + counted(in.poses->size(), "poses") +
                  ", " + counted(in.frames.size(), "frames") + " and a trajectory of " +
                  std::to_string(in.trajectory->size()) +
                  ": wire what belongs to the same segments and frames");
    Out out{*in.trajectory};
    std::vector<std::uint32_t> alone(count, 0);
    context.parallel(count, [&](std::size_t s) {
      const auto own = in.segments.open(s);
      if (own->range.end > in.trajectory->size())
        throw Error(
            "segment " + std::to_string(s) +
            " has frames that the trajectory does not have: wire segments of the same frames");
      std::vector<Target> targets;
      for (std::size_t k = s - std::min<std::size_t>(s, params.neighbours);
           k < std::min(count, s + params.neighbours + 1); ++k)
        if (k != s) targets.push_back({in.segments.open(k).shared(), in.poses->T_world_segment[k]});
      for (const Target& target : targets)
        if (!target.segment->cloud.empty() && !target.segment->cloud.has_normals())
          throw Error("the segments have no normals: put estimate.normals before");
      for (std::uint32_t f = own->range.first; f < own->range.end; ++f) {
        const auto frame = in.frames.open(f);
        const FramePose pose =
            registered(frame->cloud, in.trajectory->T_world_frame[f], targets, params.registration);
        out.trajectory.T_world_frame[f] = pose.T_world_frame;
        alone[s] += pose.pairs < 30;
      }
    });
    std::uint64_t stayed = 0;
    for (const auto n : alone) stayed += n;
    context.count("frames left in place for seeing too little of the segments around", stayed);
    return out;
  }
};

}  // namespace
}  // namespace plumb::refine_frames

PLUMB_MODULE(plumb::refine_frames::RefineFrames)
