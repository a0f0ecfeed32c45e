#include "plumb/slam/step.hpp"

#include <optional>

#include "calibration.hpp"
#include "plumb/data/io/file_text.hpp"
#include "plumb/plugin/module.hpp"
#include "plumb/slam/io/bin_file.hpp"
#include "plumb/slam/io/frame_files.hpp"
#include "plumb/slam/io/frame_selection.hpp"
#include "plumb/slam/io/trajectory_file.hpp"

namespace plumb::source_kitti {
namespace {

struct Kitti : WholeStep {
  struct In {};
  struct Out {
    Lazy<Frame> frames;
    Trajectory trajectory;
  };
  struct Params {
    std::filesystem::path path;
    std::optional<std::filesystem::path> poses, times, calibration;
    io::FrameSelection selection;
  };

  static void describe(Declaration<Kitti>& is) {
    is.name("source.kitti").version(1).source("[Geiger2012]");
    is.summary("Reads a sequence of the KITTI odometry benchmark.");
    is.output("frames", &Out::frames, "one laser scan per frame, read on demand");
    is.output("trajectory", &Out::trajectory, "stamp and pose of every frame");
    is.param("path", &Params::path).required().doc("folder of the sequence, with velodyne/*.bin");
    is.param("poses", &Params::poses)
        .doc("12 numbers a line, one line per frame; none: poses.txt in the folder");
    is.param("times", &Params::times).doc("one stamp [s] per line; none: times.txt in the folder");
    is.param("calibration", &Params::calibration)
        .doc(
            "calib.txt with the laser's extrinsics Tr: the poses are then the camera's; none: they "
            "are the laser's");
    is.params(&Params::selection);
  }

  Out run(const In&, const Params& params, Context& context) const {
    io::require_folder(params.path, "give the folder of a sequence, with velodyne/*.bin");
    io::require_folder(params.path / "velodyne",
                       "the frames of a KITTI sequence are velodyne/*.bin");
    auto files = io::files_in(params.path / "velodyne", {".bin"}, "velodyne/");
    if (files.empty())
      io::refuse(params.path / "velodyne",
                 "has no frames: expected files named 000000.bin and so on");
    const auto poses = params.poses.value_or(params.path / "poses.txt");

    Out out;
    out.trajectory = read_kitti(poses, params.times.value_or(params.path / "times.txt"));
    io::require_pose_each(params.path, files.size(), poses, out.trajectory.size());
    if (params.calibration) camera_to_laser(out.trajectory, read_calibration(*params.calibration));
    if (!params.selection.all()) {
      const auto used = params.selection.indices(files.size(), params.path.string());
      context.count("frames left out as told", files.size() - used.size());
      files = io::selected(std::move(files), used);
      out.trajectory = io::selected(std::move(out.trajectory), used);
    }

    for (const auto& file : files) out.frames.keys.push_back(io::key_of(file));
    out.frames.open = [files = std::move(files)](std::size_t k, Context& of_frame) {
      return io::frame_of(k, read_bin(files[k].path), of_frame);
    };
    return out;
  }
};

}  // namespace
}  // namespace plumb::source_kitti

PLUMB_MODULE(plumb::source_kitti::Kitti)
