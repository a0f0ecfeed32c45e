#include "plumb/slam/step.hpp"

#include "distance.hpp"
#include "plumb/plugin/module.hpp"

namespace plumb::filter_distance {
namespace {

struct Distance : FrameStep {
  struct In {
    One<Frame> frame;
  };
  struct Out {
    Frame frame;
  };
  struct Params {
    double min_range = 0.5;
    double max_range = 300;
    std::string check() const {
      return min_range < max_range ? ""
                                   : "min_range must be less than max_range, or no point is left";
    }
  };

  static void describe(Declaration<Distance>& is) {
    is.name("filter.distance").version(1).source("[Tang2024] 2.2, 3.1");
    is.summary("Keeps the points whose distance from the sensor is within bounds.");
    is.input("frame", &In::frame, "a frame in sensor coordinates");
    is.output("frame", &Out::frame, "its points within the bounds");
    is.param("min_range", &Params::min_range)
        .unit("m")
        .range(0, 1e4)
        .doc("distance from the sensor; nearer points are the carrier itself")
        .source("[Tang2024] 3.1");
    is.param("max_range", &Params::max_range)
        .unit("m")
        .range(0, 1e6)
        .doc("distance from the sensor")
        .source("[Tang2024] 3.1");
  }

  Out run(const In& in, const Params& params, Context& context) const {
    Shell shell = within_shell(in.frame->cloud, static_cast<float>(params.min_range),
                               static_cast<float>(params.max_range));
    if (shell.nearer) context.count("points nearer than min_range dropped", shell.nearer);
    if (shell.farther) context.count("points farther than max_range dropped", shell.farther);
    return {Frame{in.frame->index, std::move(shell.cloud)}};
  }
};

}  // namespace
}  // namespace plumb::filter_distance

PLUMB_MODULE(plumb::filter_distance::Distance)
