#include "plumb/slam/step.hpp"

#include <algorithm>

#include "motion_noise.hpp"
#include "plumb/data/counted.hpp"
#include "plumb/plugin/module.hpp"
#include "plumb/slam/range.hpp"

namespace plumb::constrain_odometry {
namespace {

struct ConstrainOdometry : WholeStep {
  struct In {
    One<Trajectory> trajectory;
    Each<FrameRange> ranges;
    One<Poses> registered;
    One<Metrics> scale;
  };
  struct Out {
    Constraints constraints;
    Metrics metrics;
  };
  struct Params {
    MotionNoise noise;
    double max_factor = 10;
    double max_deviation = 6;
  };

  static void describe(Declaration<ConstrainOdometry>& is) {
    is.name("constrain.odometry").version(1).source("ours");
    is.summary(
        "Makes relative-pose constraints of the odometry's motions, weighted by the odometry's "
        "accuracy.");
    is.input("trajectory", &In::trajectory, "the odometry: the poses of all frames");
    is.input(
        "ranges", &In::ranges,
        "the frames of each segment, cut from this or any other trajectory of the same frames");
    is.optional_input("registered", &In::registered,
                      "poses of the same segments after registration of neighbours: the odometry's "
                      "accuracy is measured against them, axis by axis");
    is.scale(&In::scale);
    is.output("constraints", &Out::constraints,
              "the motion from each segment to the next, with its information");
    is.output("metrics", &Out::metrics,
              "median standard deviations that were used, and how many motions contradict the "
              "registrations");
    is.params(&Params::noise);
    is.param("max_factor", &Params::max_factor)
        .range(1, 1e6)
        .doc(
            "with 'registered': the standard deviations are scaled to the observed differences, up "
            "or down by at most this factor");
    is.param("max_deviation", &Params::max_deviation)
        .range(1, 1e6)
        .doc(
            "with 'registered': a motion that differs by more standard deviations gets that "
            "difference as its standard deviation");
  }

  Out run(const In& in, const Params& params, Context& context) const {
    const Poses odometry = poses_of(in.ranges.all(context), *in.trajectory);
    if (in.registered && in.registered->size() != odometry.size())
      throw Error("got " + counted(odometry.size(), "segments") + " and " +
                  counted(in.registered->size(), "registered poses") +
                  ": wire ranges and poses of the same segments");
    const auto noise = odometry_noise(odometry, in.registered ? &*in.registered : nullptr,
                                      params.noise, params.max_factor, params.max_deviation);
    Out out;
    out.constraints = constraints_from(noise.motions);
    const char* axes[] = {"x", "y", "z", "roll", "pitch", "yaw"};
    for (int axis = 0; axis < 6; ++axis) {
      std::vector<double> sigmas;
      for (const auto& motion : noise.motions) sigmas.push_back(motion.sigma[axis]);
      std::ranges::sort(sigmas);
      out.metrics.add(std::string("sigma_") + axes[axis],
                      sigmas.empty() ? 0 : sigmas[sigmas.size() / 2], axis < 3 ? "m" : "rad");
    }
    out.metrics.add("outliers", static_cast<double>(noise.outliers.size()), "");
    context.count("motions of the odometry contradicted by the registrations",
                  noise.outliers.size());
    return out;
  }
};

}  // namespace
}  // namespace plumb::constrain_odometry

PLUMB_MODULE(plumb::constrain_odometry::ConstrainOdometry)
