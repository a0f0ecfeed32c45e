#include "simulate/simulate.hpp"

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <mutex>

#include "plumb/data/error.hpp"
#include "plumb/engine/run/parallel.hpp"
#include "plumb/slam/io/cloud_file.hpp"
#include "plumb/slam/io/trajectory_file.hpp"
#include "simulate/drift.hpp"
#include "simulate/output_folder.hpp"
#include "simulate/random.hpp"
#include "simulate/route.hpp"

namespace plumb::simulate {
namespace {

Trajectory true_path(const Scene& scene) {
  if (!follows_file(scene))
    return drive({scene.path, static_cast<std::size_t>(*scene.frames), *scene.length, scene.rate,
                  scene.height, static_cast<std::uint64_t>(scene.seed)});
  Trajectory path = read_tum(scene.path);
  if (path.size() < 2) throw Error(scene.path + ": has one pose only; a sequence needs two");
  if (scene.frames) {
    const auto frames = static_cast<std::size_t>(*scene.frames);
    if (frames > path.size())
      throw Error(scene.path + ": has " + std::to_string(path.size()) + " poses and " +
                  std::to_string(frames) + " frames are asked; ask for fewer");
    path.stamps.resize(frames);
    path.T_world_frame.resize(frames);
  }
  return path;
}

World city_along(const Trajectory& truth, const Scene& scene) {
  std::vector<Eigen::Vector3d> positions;
  positions.reserve(truth.size());
  for (const Pose& pose : truth.T_world_frame) positions.push_back(pose.translation);
  return build_city(positions, scene.height, scene.street_width, scene.alike,
                    mix(static_cast<std::uint64_t>(scene.seed), 1));
}

ScannerOptions scanner_of(const Scene& scene) {
  return {static_cast<int>(scene.lines),
          static_cast<int>(scene.columns),
          scene.lowest,
          scene.highest,
          scene.noise,
          scene.range};
}

std::string frame_name(std::size_t k) {
  char name[32];
  std::snprintf(name, sizeof name, "frames/%06zu.pcd", k);
  return name;
}

}  // namespace

Stage set_up(const Scene& given) {
  Scene scene = settled(given);
  Trajectory truth = true_path(scene);
  const double length = travelled(truth).back();
  const bool transplant = !scene.drift_odometry.empty();
  if (!transplant && !scene.drift) scene.drift = usual_drift(length);
  const auto seed = static_cast<std::uint64_t>(scene.seed);
  Trajectory odometry =
      transplant ? transplanted(truth, read_tum(scene.drift_odometry), read_tum(scene.drift_truth))
                 : drifted(truth, *scene.drift, seed);
  World world = city_along(truth, scene);
  return {scene, std::move(truth), std::move(odometry), std::move(world),
          Scanner(scanner_of(scene), mix(seed, 2))};
}

Summary simulate(const Scene& scene, const std::filesystem::path& folder, int threads,
                 const std::function<void(std::size_t, std::size_t)>& progress) {
  OutputFolder output(folder, {"frames"});
  const Stage stage = set_up(scene);
  const std::size_t frames = stage.truth.size();
  std::atomic<std::size_t> points{0}, bytes{0};
  std::size_t done = 0;
  std::mutex telling;
  with_threads(static_cast<unsigned>(std::max(threads, 0)), [&] {
    parallel_for(frames, [&](std::size_t k) {
      const Cloud cloud = stage.frame(k);
      const std::string file = pcd_bytes(cloud);
      output.write(frame_name(k), file);
      points += cloud.size();
      bytes += file.size();
      if (!progress) return;
      const std::lock_guard lock(telling);
      progress(++done, frames);
    });
  });
  output.write("truth.tum", tum_text(stage.truth));
  output.write("odometry.tum", tum_text(stage.odometry));
  const std::string unsettled = output.finish(scene_text(stage.scene));
  return {
      frames,   points, bytes, travelled(stage.truth).back(), drift_of(stage.odometry, stage.truth),
      unsettled};
}

}  // namespace plumb::simulate
