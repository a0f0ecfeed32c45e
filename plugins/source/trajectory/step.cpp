#include "plumb/slam/step.hpp"

#include "plumb/plugin/module.hpp"
#include "plumb/slam/io/trajectory_file.hpp"

namespace plumb::source_trajectory {
namespace {

struct SourceTrajectory : WholeStep {
  struct In {};
  struct Out {
    Trajectory trajectory;
  };
  struct Params {
    std::filesystem::path path;
  };

  static void describe(Declaration<SourceTrajectory>& is) {
    is.name("source.trajectory").version(1).source("[Sturm2012], the format");
    is.summary("Reads a trajectory from a TUM file.");
    is.output("trajectory", &Out::trajectory,
              "the poses in the order of the file; stamps may step back");
    is.param("path", &Params::path)
        .required()
        .doc("text file with a line 'stamp tx ty tz qx qy qz qw' for each pose (TUM)");
  }

  Out run(const In&, const Params& params, Context&) const {
    return {read_tum(params.path, StampOrder::any)};
  }
};

}  // namespace
}  // namespace plumb::source_trajectory

PLUMB_MODULE(plumb::source_trajectory::SourceTrajectory)
