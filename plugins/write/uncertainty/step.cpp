#include "plumb/slam/step.hpp"

#include <algorithm>
#include <cmath>

#include "plumb/data/document.hpp"
#include "plumb/plugin/module.hpp"
#include "table.hpp"

namespace plumb::write_uncertainty {
namespace {

struct WriteUncertainty : WholeStep {
  struct In {
    One<Constraints> uncertainty;
    Each<FrameRange> ranges;
    One<Trajectory> trajectory;
  };
  struct Out {
    Document document;
    Metrics metrics;
  };
  struct Params {
    std::string name = "uncertainty.csv";
    std::string check() const {
      return name.empty() || name.find('/') != std::string::npos
                 ? "name must be a file name without a folder, not '" + name + "'"
                 : "";
    }
  };

  static void describe(Declaration<WriteUncertainty>& is) {
    is.name("write.uncertainty").version(1).source("ours");
    is.summary("Writes the uncertainty of each frame's pose relative to the first.");
    is.input("uncertainty", &In::uncertainty, "of solve.pose_graph with 'uncertainty: true'");
    is.input("ranges", &In::ranges, "the frames of the segments that were solved");
    is.input("trajectory", &In::trajectory,
             "the poses of all frames that the uncertainty belongs to");
    is.output("document", &Out::document,
              "CSV: stamp, position, its covariance in world axes [m^2], standard deviations of "
              "the rotation [rad]");
    is.output("metrics", &Out::metrics, "median and greatest standard deviation of the positions");
    is.param("name", &Params::name).doc("name of the file in the output folder");
  }

  Out run(const In& in, const Params& params, Context& context) const {
    const std::vector<FrameRange> ranges = in.ranges.all(context);
    if (ranges.empty() || ranges.back().end != in.trajectory->size())
      throw Error("the ranges do not cover the trajectory of " +
                  std::to_string(in.trajectory->size()) +
                  " frames: wire the ranges that it was cut into");
    if (in.uncertainty->absolute.empty())
      context.warn(
          "no uncertainty came in: set 'uncertainty: true' at the step solve.pose_graph that it is "
          "wired to");
    const auto frames =
        of_frames(uncertainty_of(*in.uncertainty, ranges.size()), ranges, in.trajectory->size());
    std::vector<double> sigmas;
    for (const auto& frame : frames)
      sigmas.push_back(std::sqrt(std::max(0.0, frame.position.trace())));
    std::ranges::sort(sigmas);
    Out out;
    out.document = {params.name, uncertainty_table(*in.trajectory, frames)};
    out.metrics.add("position_sigma_median", sigmas[sigmas.size() / 2], "m")
        .add("position_sigma_max", sigmas.back(), "m");
    return out;
  }
};

}  // namespace
}  // namespace plumb::write_uncertainty

PLUMB_MODULE(plumb::write_uncertainty::WriteUncertainty)
