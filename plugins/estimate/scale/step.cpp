#include "plumb/slam/step.hpp"

#include "plumb/plugin/module.hpp"
#include "scale.hpp"

namespace plumb::estimate_scale {
namespace {

struct EstimateScale : WholeStep {
  struct In {
    One<Trajectory> trajectory;
  };
  struct Out {
    Metrics scale;
  };
  struct Params {
    std::optional<double> factor;
    double full_speed = 4;
    double min_factor = 0.25;
  };

  static void describe(Declaration<EstimateScale>& is) {
    is.name("estimate.scale").version(1).source("ours");
    is.summary(
        "Estimates the scale of the surroundings relative to a street, by which other steps "
        "multiply their lengths.");
    is.input("trajectory", &In::trajectory, "the odometry, for its speed");
    is.output("scale", &Out::scale, "the factor, then the speed from which it is derived");
    is.param("factor", &Params::factor)
        .range(0.01, 100)
        .doc("the factor itself, if it is known; none: from the speed");
    is.param("full_speed", &Params::full_speed)
        .unit("m/s")
        .range(0.01, 1000)
        .doc("from this speed on the factor is 1; below it is proportional to the speed");
    is.param("min_factor", &Params::min_factor)
        .range(0.01, 1)
        .doc("lower bound of the factor from the speed");
  }

  Out run(const In& in, const Params& params, Context&) const {
    const double speed = usual_speed(*in.trajectory);
    Out out;
    out.scale
        .add("scale", params.factor.value_or(scale_at(speed, params.full_speed, params.min_factor)),
             "")
        .add("speed", speed, "m/s");
    return out;
  }
};

}  // namespace
}  // namespace plumb::estimate_scale

PLUMB_MODULE(plumb::estimate_scale::EstimateScale)
