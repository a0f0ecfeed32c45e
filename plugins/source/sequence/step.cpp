#include "plumb/slam/step.hpp"

#include <memory>
#include <optional>

#include "plumb/plugin/module.hpp"
#include "plumb/slam/io/cloud_file.hpp"
#include "plumb/slam/io/frame_files.hpp"
#include "plumb/slam/io/frame_selection.hpp"
#include "plumb/slam/io/trajectory_file.hpp"
#include "sequence_folder.hpp"

namespace plumb::source_sequence {
namespace {

enum class Coordinates { sensor, world };

struct Sequence : WholeStep {
  struct In {};
  struct Out {
    Lazy<Frame> frames;
    Trajectory trajectory;
  };
  struct Params {
    std::filesystem::path path;
    std::optional<std::filesystem::path> trajectory;
    Coordinates coordinates = Coordinates::sensor;
    io::FrameSelection selection;
  };

  static void describe(Declaration<Sequence>& is) {
    is.name("source.sequence").version(1).source("Plumb");
    is.summary("Reads a folder of PCD or PLY frames and their SLAM trajectory.");
    is.output("frames", &Out::frames, "one cloud per frame, in sensor coordinates, read on demand");
    is.output("trajectory", &Out::trajectory, "stamp and pose of every frame");
    is.param("path", &Params::path)
        .required()
        .doc("folder with frames/*.pcd or *.ply, or frames.txt, a list of them");
    is.param("trajectory", &Params::trajectory)
        .doc("TUM file with one pose per frame; none: odometry.tum in the folder");
    is.choice("coordinates", &Params::coordinates,
              {{"sensor", Coordinates::sensor, "the clouds are as the sensor saw them"},
               {"world", Coordinates::world,
                "the clouds were already transformed by the trajectory's poses"}})
        .doc("coordinates that the clouds are stored in");
    is.params(&Params::selection);
  }

  Out run(const In&, const Params& params, Context& context) const {
    auto files = io::sequence_frames(params.path);
    const auto poses_from = params.trajectory.value_or(params.path / "odometry.tum");
    auto poses = read_tum(poses_from);
    io::require_pose_each(params.path, files.size(), poses_from, poses.size());
    if (!params.selection.all()) {
      const auto used = params.selection.indices(files.size(), params.path.string());
      context.count("frames left out as told", files.size() - used.size());
      files = io::selected(std::move(files), used);
      poses = io::selected(std::move(poses), used);
    }
    const auto trajectory = std::make_shared<const Trajectory>(std::move(poses));

    const bool world = params.coordinates == Coordinates::world;
    Out out;
    out.trajectory = *trajectory;
    for (std::size_t k = 0; k < files.size(); ++k)
      out.frames.keys.push_back(key_of_frame(files[k], world, trajectory->T_world_frame[k]));
    out.frames.open = [files = std::move(files), trajectory, world](std::size_t k,
                                                                    Context& of_frame) {
      Frame frame = io::frame_of(k, read_cloud(files[k].path), of_frame);
      if (world) bring_to_frame(frame.cloud, trajectory->T_world_frame[k]);
      return frame;
    };
    return out;
  }

  /// In world coordinates the frame depends on its pose too.
  static Hash128 key_of_frame(const io::FrameFile& file, bool world, const Pose& T_world_frame) {
    const Hash128 of_file = io::key_of(file);
    if (!world) return of_file;
    Hasher hasher;
    hasher.bytes(&of_file, sizeof of_file);
    hasher.bytes(T_world_frame.rotation.coeffs().data(), 4 * sizeof(double));
    hasher.bytes(T_world_frame.translation.data(), 3 * sizeof(double));
    return hasher.hash();
  }
};

}  // namespace
}  // namespace plumb::source_sequence

PLUMB_MODULE(plumb::source_sequence::Sequence)
