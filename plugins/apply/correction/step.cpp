#include "plumb/slam/step.hpp"

#include "correction.hpp"
#include "plumb/plugin/module.hpp"

namespace plumb::apply_correction {
namespace {

struct ApplyCorrection : WholeStep {
  struct In {
    One<Trajectory> trajectory;
    Each<FrameRange> ranges;
    One<Poses> poses;
  };
  struct Out {
    Trajectory trajectory;
  };
  struct Params {
    bool blend = true;
  };

  static void describe(Declaration<ApplyCorrection>& is) {
    is.name("apply.correction")
        .version(1)
        .summary("Moves every frame with its segment to the new poses of the segments.")
        .source("ours; [Tang2024] stops at segments");
    is.input("trajectory", &In::trajectory,
             "the poses of all frames as they were cut into segments");
    is.input("ranges", &In::ranges, "the frames of each segment, and the segments' original poses");
    is.input("poses", &In::poses, "the new poses of the segments");
    is.output("trajectory", &Out::trajectory, "the corrected poses of all frames");
    is.param("blend", &Params::blend)
        .doc(
            "interpolate between the corrections of neighbouring segments, so that the trajectory "
            "stays smooth");
  }

  Out run(const In& in, const Params& params, Context& context) const {
    return {corrected(*in.trajectory, in.ranges.all(context), *in.poses, params.blend)};
  }
};

}  // namespace
}  // namespace plumb::apply_correction

PLUMB_MODULE(plumb::apply_correction::ApplyCorrection)
