#include "scans.hpp"

#include <algorithm>
#include <numbers>

#include "plumb/data/io/file_text.hpp"
#include "plumb/slam/io/trajectory_file.hpp"

namespace plumb::source_mulran {

namespace fs = std::filesystem;

std::vector<Scan> scans_of(const fs::path& folder) {
  io::require_folder(folder, "give a folder with Ouster/*.bin or *.bin");
  std::error_code error;
  const bool inner = fs::is_directory(folder / "Ouster", error);
  const auto files =
      inner ? io::files_in(folder / "Ouster", {".bin"}, "Ouster/") : io::files_in(folder, {".bin"});
  if (files.empty())
    io::refuse(folder, "has no frames: expected Ouster/*.bin or *.bin, named by their stamps");

  std::vector<std::pair<std::uint64_t, io::FrameFile>> stamped;
  for (const auto& file : files) {
    std::uint64_t nanoseconds = 0;
    const std::string stem = file.path.stem().string();
    if (!io::to_number(std::string_view(stem), nanoseconds))
      io::refuse(file.path,
                 "is not named by its stamp: expected nanoseconds, as in 1567410201812840928.bin");
    stamped.emplace_back(nanoseconds, file);
  }
  std::ranges::sort(stamped, {}, &std::pair<std::uint64_t, io::FrameFile>::first);
  std::vector<Scan> scans;
  for (const auto& [nanoseconds, file] : stamped) {
    // Seconds since 1970 as a double are exact to 0.24 us.
    const double stamp = static_cast<double>(nanoseconds) * 1e-9;
    if (!scans.empty() && !(stamp > scans.back().stamp))
      io::refuse(file.path, "has the same time as " + scans.back().file.name +
                                ": a trajectory has one pose a time, so remove one");
    scans.push_back({file, stamp});
  }
  return scans;
}

PlacedScans placed(const std::vector<Scan>& scans, const Trajectory& trajectory,
                   double max_time_gap) {
  PlacedScans result;
  const auto& stamps = trajectory.stamps;
  for (const Scan& scan : scans) {
    const auto after = std::ranges::lower_bound(stamps, scan.stamp);
    const bool exact = after != stamps.end() && *after == scan.stamp;
    if (after == stamps.end() || (after == stamps.begin() && !exact)) {
      ++result.outside;
    } else if (!exact && *after - *(after - 1) > max_time_gap) {
      ++result.in_gap;
    } else {
      result.scans.push_back(scan);
      result.trajectory.stamps.push_back(scan.stamp);
      result.trajectory.T_world_frame.push_back(pose_at(trajectory, scan.stamp, 0));
    }
  }
  return result;
}

Pose mulran_laser_on_vehicle() {
  constexpr double degree = std::numbers::pi / 180;
  const Eigen::Quaterniond rotation =
      Eigen::AngleAxisd(179.6654 * degree, Eigen::Vector3d::UnitZ()) *
      Eigen::AngleAxisd(0.0003 * degree, Eigen::Vector3d::UnitY()) *
      Eigen::AngleAxisd(0.0001 * degree, Eigen::Vector3d::UnitX());
  return {rotation.normalized(), Eigen::Vector3d(1.7042, -0.021, 1.8047)};
}

}  // namespace plumb::source_mulran
