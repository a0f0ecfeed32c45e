#include "simulate/indoor.hpp"

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <mutex>

#include "plumb/engine/run/parallel.hpp"
#include "plumb/slam/io/trajectory_file.hpp"
#include "simulate/output_folder.hpp"
#include "simulate/random.hpp"

namespace plumb::simulate {
namespace {

double usual_drift(const IndoorScene& scene, const IndoorDrive& drive) {
  return scene.path == "lookalike" ? 0.4 * scene.spacing : 0.03 * way_length(drive.poses);
}

void append(std::string& line, double value, int decimals) {
  char text[64];
  const auto end =
      std::to_chars(text, text + sizeof text, value, std::chars_format::fixed, decimals);
  line += ' ';
  line.append(text, end.ptr);
}

void append(std::string& line, const PlanarPose& pose) {
  for (const double value : {pose.x, pose.y, pose.yaw}) append(line, value, 6);
}

/// The last three fields of every line: the stamp, the host, the stamp of the logger.
void finish(std::string& line, double stamp) {
  append(line, stamp, 6);
  line += " plumb";
  append(line, stamp, 6);
  line += '\n';
}

/// `ODOM x y theta tv rv accel`.
std::string odom_line(const IndoorStage& stage, std::size_t k) {
  std::string line = "ODOM";
  const PlanarPose &pose = stage.odometry[k], &before = stage.odometry[k > 0 ? k - 1 : 0];
  append(line, pose);
  append(line, stage.scene.rate * std::hypot(pose.x - before.x, pose.y - before.y), 6);
  append(line, stage.scene.rate * planar::wrapped(pose.yaw - before.yaw), 6);
  append(line, 0, 6);
  finish(line, stage.drive.stamps[k]);
  return line;
}

/// `ROBOTLASER1 laser_type start_angle field_of_view angular_resolution maximum_range accuracy
/// remission_mode num_readings [readings] num_remissions laser_pose robot_pose laser_tv laser_rv
/// forward_safety_dist side_safety_dist turn_axis`.
std::string scan_line(const IndoorStage& stage, std::size_t k) {
  const std::vector<double> ranges = stage.scan(k);
  std::string line = "ROBOTLASER1 0";
  append(line, stage.laser.first_angle(), 9);
  append(line, stage.scene.field_of_view, 9);
  append(line, stage.laser.step(), 9);
  append(line, stage.scene.range, 3);
  append(line, stage.scene.noise, 4);
  line += " 0 " + std::to_string(ranges.size());
  for (const double range : ranges) append(line, range, 3);
  line += " 0";
  append(line, stage.odometry[k]);
  append(line, stage.odometry[k]);
  line += " 0 0 0 0 0";
  finish(line, stage.drive.stamps[k]);
  return line;
}

std::string log_head(const IndoorScene& scene) {
  return "# A building called " + scene.path +
         ", simulated. Lines end in: stamp host logger_stamp\n"
         "# ODOM x y theta tv rv accel\n"
         "# ROBOTLASER1 laser_type start_angle field_of_view angular_resolution maximum_range "
         "accuracy remission_mode num_readings [readings] num_remissions [remissions] laser_pose_x "
         "laser_pose_y laser_pose_theta robot_pose_x robot_pose_y robot_pose_theta laser_tv "
         "laser_rv forward_safety_dist side_safety_dist turn_axis\n"
         "PARAM robot_frontlaser_offset 0.0 nohost 0\n";
}

std::string plan_text(const std::vector<Wall>& walls) {
  std::string text;
  for (const Wall& wall : walls) {
    char line[128];
    std::snprintf(line, sizeof line, "%.6f %.6f %.6f %.6f\n", wall.a.x(), wall.a.y(), wall.b.x(),
                  wall.b.y());
    text += line;
  }
  return text;
}

Trajectory kept(const std::vector<PlanarPose>& poses, const IndoorStage& stage) {
  Trajectory trajectory;
  for (std::size_t k = 0; k < poses.size(); ++k) {
    if (stage.lost[k]) continue;
    trajectory.stamps.push_back(stage.drive.stamps[k]);
    trajectory.T_world_frame.push_back(in_space(poses[k]));
  }
  return trajectory;
}

double greatest_error(const IndoorStage& stage) {
  double greatest = 0;
  for (std::size_t k = 0; k < stage.drive.size(); ++k)
    greatest = std::max(greatest, std::hypot(stage.odometry[k].x - stage.drive.poses[k].x,
                                             stage.odometry[k].y - stage.drive.poses[k].y));
  return greatest;
}

}  // namespace

IndoorStage set_up(const IndoorScene& given) {
  IndoorScene scene = settled(given);
  const auto seed = static_cast<std::uint64_t>(scene.seed);
  Building building =
      build({scene.path, *scene.length, scene.spacing, *scene.overlap, mix(seed, 3)});
  IndoorDrive drive =
      drive_indoors(building.way, {scene.speed, scene.turn_rate, scene.rate, mix(seed, 4)});
  if (!scene.drift) scene.drift = usual_drift(scene, drive);
  std::vector<PlanarPose> odometry = wheel_odometry(drive.poses, *scene.drift, mix(seed, 5));
  std::vector<char> lost =
      lost_scans(drive, {scene.drop_in_turns, scene.kidnap, scene.kidnap_time, mix(seed, 6)});
  const Laser2d laser({scene.field_of_view, scene.columns, scene.range, scene.noise}, mix(seed, 7));
  return {scene, std::move(building), std::move(drive), std::move(odometry), std::move(lost),
          laser};
}

IndoorSummary simulate(const IndoorScene& scene, const std::filesystem::path& folder, int threads,
                       const std::function<void(std::size_t, std::size_t)>& progress) {
  OutputFolder output(folder);
  const IndoorStage stage = set_up(scene);
  std::vector<std::string> lines(stage.drive.size());
  const auto lost = static_cast<std::size_t>(std::count(stage.lost.begin(), stage.lost.end(), 1));
  const std::size_t scans = lines.size() - lost;
  std::size_t done = 0;
  std::mutex telling;
  with_threads(static_cast<unsigned>(std::max(threads, 0)), [&] {
    parallel_for(lines.size(), [&](std::size_t k) {
      lines[k] = odom_line(stage, k);
      if (stage.lost[k]) return;
      lines[k] += scan_line(stage, k);
      if (!progress) return;
      const std::lock_guard lock(telling);
      progress(++done, scans);
    });
  });
  std::string log = log_head(stage.scene);
  for (const std::string& line : lines) log += line;
  output.write("log.clf", log);
  output.write("truth.tum", tum_text(kept(stage.drive.poses, stage)));
  output.write("odometry.tum", tum_text(kept(stage.odometry, stage)));
  output.write("plan.txt", plan_text(stage.building.walls));
  std::string unsettled = output.finish(scene_text(stage.scene));
  return {scans,
          lost,
          log.size(),
          way_length(stage.drive.poses),
          greatest_error(stage),
          std::move(unsettled)};
}

}  // namespace plumb::simulate
