#include "correction.hpp"
#include "plumb/plugin/module.hpp"

namespace plumb {
namespace {

struct ApplyCorrection : WholeStep {
  struct In {
    One<Trajectory> trajectory;
    Each<Range> ranges;
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
        .summary("Gives every frame its new pose, from the new poses of the segments.")
        .source("ours; [Tang2024] stops at segments");
    is.input("trajectory", &In::trajectory,
             "the poses of all frames as they were cut into segments");
    is.input("ranges", &In::ranges, "the segments' frames, and where the segments were");
    is.input("poses", &In::poses, "where the segments are now");
    is.output("trajectory", &Out::trajectory, "the corrected poses of all frames");
    is.param("blend", &Params::blend)
        .doc("blend the corrections of neighbouring segments, so that the trajectory stays smooth");
  }

  Out run(const In& in, const Params& params, Context&) const {
    std::vector<Range> ranges;
    for (std::size_t s = 0; s < in.ranges.size(); ++s) ranges.push_back(*in.ranges.open(s));
    return {corrected(*in.trajectory, ranges, *in.poses, params.blend)};
  }
};

}  // namespace
}  // namespace plumb

PLUMB_MODULE(plumb::ApplyCorrection)
