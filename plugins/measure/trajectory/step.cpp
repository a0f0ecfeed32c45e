#include "plumb/slam/step.hpp"

#include <filesystem>

#include "displacement.hpp"
#include "plumb/plugin/module.hpp"
#include "plumb/slam/io/trajectory_file.hpp"
#include "plumb/slam/trajectory_error.hpp"

namespace plumb::measure_trajectory {
namespace {

struct MeasureTrajectory : WholeStep {
  struct In {
    Several<Trajectory> trajectories;
  };
  struct Out {
    Metrics metrics;
  };
  struct Params {
    std::optional<std::filesystem::path> truth;
    double tolerance = 2e-3;
    double delta = 10;
  };

  static void describe(Declaration<MeasureTrajectory>& is) {
    is.name("measure.trajectory")
        .version(2)
        .summary(
            "Measures the absolute and relative pose errors of trajectories against a true one.")
        .source("[Sturm2012]; [Zhang2023] 3 for the displacement");
    is.input("trajectories", &In::trajectories,
             "any number of trajectories; numbers are named after the label");
    is.output("metrics", &Out::metrics,
              "for each trajectory ate, ate_max, rpe_translation, rpe_rotation, displacement_x, "
              "displacement_y");
    is.param("truth", &Params::truth)
        .doc("TUM file with the true poses; none: a note, and no numbers");
    is.param("tolerance", &Params::tolerance)
        .unit("s")
        .range(1e-9, 10)
        .doc("poses whose stamps differ by less are associated");
    is.param("delta", &Params::delta)
        .unit("m")
        .range(1e-3, 1e6)
        .doc("path length over which the relative pose error is taken");
  }

  Out run(const In& in, const Params& params, Context& context) const {
    Out out;
    if (!params.truth) {
      out.metrics.notes.push_back("no truth was given, so the trajectories' errors are not known");
      return out;
    }
    const Trajectory truth = read_tum(*params.truth, StampOrder::any);
    for (const auto& [label, trajectory] : in.trajectories) {
      const PosePairs pairs = pair_by_stamp(*trajectory, truth, params.tolerance);
      const std::string of = label.empty() ? "" : label + ".";
      if (pairs.size() < 3) {
        const std::string sentence = "poses of " +
                                     (label.empty() ? "the trajectory" : "'" + label + "'") +
                                     " with a stamp of the truth: only " +
                                     std::to_string(pairs.size()) + "; the error needs 3";
        out.metrics.notes.push_back(sentence);
        context.warn(sentence + "; look whether both files count the same seconds");
        continue;
      }
      const auto absolute = absolute_error(pairs);
      const auto relative = relative_error(pairs, params.delta);
      const auto displacement = mean_displacement(pairs);
      out.metrics.add(of + "ate", absolute.rmse, "m")
          .add(of + "ate_max", absolute.max, "m")
          .add(of + "rpe_translation", relative.translation, "m")
          .add(of + "rpe_rotation", relative.rotation, "rad")
          .add(of + "displacement_x", displacement.x(), "m")
          .add(of + "displacement_y", displacement.y(), "m");
    }
    return out;
  }
};

}  // namespace
}  // namespace plumb::measure_trajectory

PLUMB_MODULE(plumb::measure_trajectory::MeasureTrajectory)
