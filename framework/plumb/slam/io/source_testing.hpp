#pragma once
/// For tests of a source of frames: what it gives, as the engine asks for it. plumb_module() of the
/// module itself is linked in.

#include "plumb/data/io/file_testing.hpp"
#include "plumb/plugin/module.hpp"
#include "plumb/plugin/testing.hpp"
#include "plumb/slam/step.hpp"

extern "C" const PlumbModule* plumb_module();

namespace plumb {

struct SourceResult {
  LazyItems frames;
  Trajectory trajectory;
  TestContext context;

  Frame frame(std::size_t k) { return *frames.open(k, context).as<Frame>(); }
  Cloud cloud(std::size_t k) { return frame(k).cloud; }
  std::uint64_t count(const std::string& what) { return context.counts[what]; }
};

/// The frames and the trajectory of the module's only step.
inline SourceResult read_source(const ParameterValues& values) {
  const Step& step = *plumb_module()->steps[0];
  PortOutput outputs[2];
  SourceResult result;
  step.run(step.parameters(values).get(), {}, outputs, result.context);
  result.frames = outputs[0].lazy;
  result.trajectory = *outputs[1].one.as<Trajectory>();
  return result;
}

}  // namespace plumb
