#include "plumb/plugin/module.hpp"
#include "scale.hpp"

namespace plumb {
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
    double min = 0.25;
  };

  static void describe(Declaration<EstimateScale>& is) {
    is.name("estimate.scale").version(1).source("ours");
    is.summary(
        "Tells how large the surroundings are beside a street: lengths of other steps are "
        "multiplied by it.");
    is.input("trajectory", &In::trajectory, "the odometry: who moves fast needs room");
    is.output("scale", &Out::scale, "the factor, first; the speed that it comes from");
    is.param("factor", &Params::factor)
        .range(0.01, 100)
        .doc("the factor itself, for who knows it; none: from the speed");
    is.param("full_speed", &Params::full_speed)
        .unit("m/s")
        .range(0.01, 1000)
        .doc("from this speed on the surroundings count as a street (1), below in proportion");
    is.param("min", &Params::min).range(0.01, 1).doc("the smallest factor that a speed gives");
  }

  Out run(const In& in, const Params& params, Context&) const {
    const double speed = usual_speed(*in.trajectory);
    Out out;
    out.scale
        .add("scale", params.factor.value_or(scale_at(speed, params.full_speed, params.min)), "")
        .add("speed", speed, "m/s");
    return out;
  }
};

}  // namespace
}  // namespace plumb

PLUMB_MODULE(plumb::EstimateScale)
