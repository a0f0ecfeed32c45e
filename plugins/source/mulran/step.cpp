#include "plumb/slam/step.hpp"

#include "plumb/data/counted.hpp"
#include "plumb/data/io/file_text.hpp"
#include "plumb/plugin/module.hpp"
#include "plumb/slam/io/bin_file.hpp"
#include "plumb/slam/io/frame_selection.hpp"
#include "plumb/slam/io/trajectory_file.hpp"
#include "scans.hpp"

namespace plumb::source_mulran {
namespace {

enum class Body { sensor, vehicle };

struct MulRan : WholeStep {
  struct In {};
  struct Out {
    Lazy<Frame> frames;
    Trajectory trajectory;
  };
  struct Params {
    std::filesystem::path path;
    std::optional<std::filesystem::path> trajectory;
    Body poses_of = Body::sensor;
    double max_time_gap = 1;
    io::FrameSelection selection;
  };

  static void describe(Declaration<MulRan>& is) {
    is.name("source.mulran").version(1).source("[Kim2020]");
    is.summary("Reads laser scans of the MulRan data set and a trajectory with its own stamps.");
    is.output("frames", &Out::frames, "one laser scan per frame, read on demand");
    is.output("trajectory", &Out::trajectory, "stamp and pose of every frame");
    is.param("path", &Params::path)
        .required()
        .doc("folder with Ouster/*.bin or *.bin, named by their stamps [ns]");
    is.param("trajectory", &Params::trajectory)
        .doc(
            "TUM file (.tum, .txt) or MulRan's global_pose.csv (.csv); none: odometry.tum in the "
            "folder");
    is.choice("poses_of", &Params::poses_of,
              {{"sensor", Body::sensor, "the laser, as SLAM systems write them"},
               {"vehicle", Body::vehicle, "MulRan's car, as in global_pose.csv"}})
        .doc("the body whose poses the trajectory holds");
    is.param("max_time_gap", &Params::max_time_gap)
        .unit("s")
        .range(0, 3600)
        .doc("time between two poses up to which scans between them are interpolated and kept");
    is.params(&Params::selection);
  }

  Out run(const In&, const Params& params, Context& context) const {
    const auto scans = scans_of(params.path);
    const auto poses_from = params.trajectory.value_or(params.path / "odometry.tum");
    auto placing = placed(scans, read_trajectory(poses_from), params.max_time_gap);
    if (placing.outside)
      context.count("frames outside the trajectory's time left out", placing.outside);
    if (placing.in_gap) context.count("frames in gaps of the trajectory left out", placing.in_gap);
    if (placing.scans.size() < 2)
      io::refuse(params.path, "has " + counted(scans.size(), "frames") + ", of which " +
                                  std::to_string(placing.scans.size()) +
                                  " lie within the time of " + poses_from.string() +
                                  ", but at least 2 are needed: give the trajectory of this drive");
    if (!params.selection.all()) {
      const auto used = params.selection.indices(placing.scans.size(), params.path.string());
      context.count("frames left out as told", placing.scans.size() - used.size());
      placing.scans = io::selected(std::move(placing.scans), used);
      placing.trajectory = io::selected(std::move(placing.trajectory), used);
    }
    if (params.poses_of == Body::vehicle)
      for (Pose& pose : placing.trajectory.T_world_frame) pose = pose * mulran_laser_on_vehicle();

    Out out;
    out.trajectory = std::move(placing.trajectory);
    for (const Scan& scan : placing.scans) out.frames.keys.push_back(io::key_of(scan.file));
    out.frames.open = [kept = std::move(placing.scans)](std::size_t k, Context& reading) {
      return io::frame_of(k, read_bin(kept[k].file.path), reading);
    };
    return out;
  }

  static Trajectory read_trajectory(const std::filesystem::path& file) {
    const std::string extension = file.extension().string();
    if (extension == ".csv") return read_mulran_csv(file);
    if (extension == ".tum" || extension == ".txt") return read_tum(file);
    io::refuse(file, "is neither .tum, .txt nor .csv, so its format is not known: rename it");
  }
};

}  // namespace
}  // namespace plumb::source_mulran

PLUMB_MODULE(plumb::source_mulran::MulRan)
