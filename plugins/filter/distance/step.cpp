#include "distance.hpp"
#include "plumb/plugin/module.hpp"

namespace plumb {
namespace {

struct Distance : FrameStep {
  struct In {
    One<Frame> frame;
  };
  struct Out {
    Frame frame;
  };
  struct Params {
    double min = 0.5;
    double max = 300;
    std::string check() const {
      return min < max ? "" : "min must be less than max, or no point is left";
    }
  };

  static void describe(Declaration<Distance>& is) {
    is.name("filter.distance").version(1).source("[Tang2024] 2.2, 3.1");
    is.summary("Keeps the points that are neither too near to the sensor nor too far from it.");
    is.input("frame", &In::frame, "a frame in sensor coordinates");
    is.output("frame", &Out::frame, "its points within the distances");
    is.param("min", &Params::min)
        .unit("m")
        .range(0, 1e4)
        .doc("least distance from the sensor: nearer is the carrier itself")
        .source("[Tang2024] 3.1");
    is.param("max", &Params::max)
        .unit("m")
        .range(0, 1e6)
        .doc("greatest distance from the sensor")
        .source("[Tang2024] 3.1");
  }

  Out run(const In& in, const Params& params, Context& context) const {
    Shell shell = within_shell(in.frame->cloud, static_cast<float>(params.min),
                               static_cast<float>(params.max));
    if (shell.nearer) context.count("points nearer than min dropped", shell.nearer);
    if (shell.farther) context.count("points farther than max dropped", shell.farther);
    return {Frame{in.frame->index, std::move(shell.cloud)}};
  }
};

}  // namespace
}  // namespace plumb

PLUMB_MODULE(plumb::Distance)
