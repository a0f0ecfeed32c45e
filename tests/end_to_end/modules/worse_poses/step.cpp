/// Poses whose error is so many times as large: what a comparison must find worse, or better.
#include "plumb/slam/step.hpp"

#include <cstddef>
#include <filesystem>
#include <optional>
#include <vector>

#include "plumb/plugin/module.hpp"
#include "plumb/slam/geometry/alignment.hpp"
#include "plumb/slam/io/trajectory_file.hpp"
#include "plumb/slam/trajectory_error.hpp"

namespace plumb {
namespace {

struct WorsePoses : WholeStep {
  struct In {
    One<Trajectory> trajectory;
  };
  struct Out {
    Trajectory trajectory;
  };
  struct Params {
    std::optional<std::filesystem::path> truth;
    double factor = 1;
  };

  static void describe(Declaration<WorsePoses>& is) {
    is.name("test.worse_poses").version(1).summary("Multiplies the error of each position.");
    is.input("trajectory", &In::trajectory, "the poses");
    is.output("trajectory", &Out::trajectory, "the same, each so many times as far from the truth");
    is.param("truth", &Params::truth).doc("TUM file with the true poses; none: nothing is moved");
    is.param("factor", &Params::factor).range(0, 1000).doc("by which the error is multiplied");
  }

  /// The alignment that is best stays the best one, so that the ATE is multiplied by `factor`.
  Out run(const In& in, const Params& params, Context&) const {
    Out out{*in.trajectory};
    if (!params.truth || params.factor == 1) return out;
    const PosePairs pairs = pair_by_stamp(out.trajectory, read_tum(*params.truth, StampOrder::any));
    if (pairs.size() != out.trajectory.size())
      throw Error("test.worse_poses: the truth has no pose for some of the stamps");
    std::vector<Eigen::Vector3d> estimate, truth;
    for (const Pose& pose : pairs.estimate) estimate.push_back(pose.translation);
    for (const Pose& pose : pairs.truth) truth.push_back(pose.translation);
    const Pose T_truth_estimate = align(estimate, truth);
    for (std::size_t k = 0; k < estimate.size(); ++k) {
      const Eigen::Vector3d more =
          (params.factor - 1) * (T_truth_estimate * estimate[k] - truth[k]);
      out.trajectory.T_world_frame[k].translation += T_truth_estimate.rotation.conjugate() * more;
    }
    return out;
  }
};

}  // namespace
}  // namespace plumb

PLUMB_MODULE(plumb::WorsePoses)
