#include "plumb/slam/step.hpp"

#include <cstdio>

#include "divergence.hpp"
#include "plumb/plugin/module.hpp"

namespace plumb::check_odometry {
namespace {

std::string seconds(double stamp) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3f", stamp);
  return text;
}

struct CheckOdometry : WholeStep {
  struct In {
    Each<Frame> frames;
    One<Trajectory> trajectory;
    One<Metrics> scale;
  };
  struct Out {
    Trajectory trajectory;
    Metrics metrics;
  };
  struct Params {
    double voxel_size = 0.4;
    double max_distance = 1;
    std::uint32_t max_points = 500;
    double min_path_length = 3;
    std::uint32_t max_frames = 5;
    double max_misfit_ratio = 0.5;
    double min_translation = 0.7;
    double single_factor = 4;
    double min_rotation = 10 * deg;
  };

  static void describe(Declaration<CheckOdometry>& is) {
    is.name("check.odometry").version(1).source("ours");
    is.summary(
        "Finds where the odometry contradicts the scans (jumps, standstills, wrong scale or "
        "rotation) and replaces it by scan-to-scan registration there.");
    is.input("frames", &In::frames, "the scans");
    is.input("trajectory", &In::trajectory, "the odometry: the poses of all frames");
    is.scale(&In::scale);
    is.output(
        "trajectory", &Out::trajectory,
        "the odometry; where it is contradicted, with the motions from scan-to-scan registration");
    is.output("metrics", &Out::metrics,
              "pairs compared and contradicted; a note for each contradicted stretch, with frames "
              "and times");
    is.param("voxel_size", &Params::voxel_size)
        .unit("m")
        .range(0.01, 100)
        .doc("edge length of the voxels to which scans are downsampled");
    is.param("max_distance", &Params::max_distance)
        .unit("m")
        .range(0.01, 1000)
        .doc("distances to the nearest point of the other scan are truncated at this value");
    is.param("max_points", &Params::max_points)
        .range(50, 1e6)
        .doc("points of a scan that are tested, evenly selected");
    is.param("min_path_length", &Params::min_path_length)
        .unit("m")
        .range(0, 1e6)
        .doc(
            "path between two scans that are compared; a frame counts for at least the motion that "
            "three quarters of the frames exceed");
    is.param("max_frames", &Params::max_frames)
        .range(1, 1e6)
        .doc("frames between two scans that are compared");
    is.param("max_misfit_ratio", &Params::max_misfit_ratio)
        .unit("%")
        .range(0, 1)
        .doc(
            "the odometry is contradicted where another motion's misfit is at most this share of "
            "its own");
    is.param("min_translation", &Params::min_translation)
        .unit("m")
        .range(0, 1000)
        .doc("the other motion must differ from the odometry by this translation, or ...");
    is.param("min_rotation", &Params::min_rotation)
        .unit("rad")
        .range(0, 180 * deg)
        .doc("... by this rotation");
    is.param("single_factor", &Params::single_factor)
        .range(1, 1000)
        .doc(
            "where a single pair in a row is contradicted, it must differ by this multiple of the "
            "two bounds");
  }

  Out run(const In& in, const Params& params, Context& context) const {
    require_pose_each(*in.trajectory, in.frames.size());
    const DivergenceOptions options{{params.voxel_size, params.max_distance, params.max_points},
                                    params.min_path_length,
                                    params.max_frames,
                                    params.max_misfit_ratio,
                                    params.min_translation,
                                    params.min_rotation,
                                    params.single_factor};
    auto checked = check_odometry(
        *in.trajectory, [&](std::size_t k) { return in.frames.open(k).shared(); }, options,
        context);
    Out out;
    out.metrics.add("divergences", static_cast<double>(checked.divergences.size()), "")
        .add("pairs_compared", checked.compared, "");
    for (const Divergence& d : checked.divergences) {
      const auto& stamps = in.trajectory->stamps;
      out.metrics.notes.push_back("the odometry " + kind_of(d) + " against the scans from frame " +
                                  std::to_string(d.first) + " (" + seconds(stamps[d.first]) +
                                  " s) to frame " + std::to_string(d.last) + " (" +
                                  seconds(stamps[d.last]) +
                                  " s); that stretch takes its motion from the scans");
    }
    out.trajectory = std::move(checked.trajectory);
    return out;
  }
};

}  // namespace
}  // namespace plumb::check_odometry

PLUMB_MODULE(plumb::check_odometry::CheckOdometry)
