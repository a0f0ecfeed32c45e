/// Trajectories as 3x4 matrices: KITTI's poses and MulRan's CSV.

#include <array>
#include <cmath>
#include <span>

#include "plumb/data/counted.hpp"
#include "plumb/slam/io/trajectory_file.hpp"
#include "plumb/slam/io/trajectory_text.hpp"

namespace plumb {
namespace {

using namespace io;
using Path = std::filesystem::path;

/// The pose of a row-major 3x4 matrix.
Pose pose_of(const Path& file, std::size_t line, std::span<const double, 12> v) {
  Eigen::Matrix3d r;
  r << v[0], v[1], v[2], v[4], v[5], v[6], v[8], v[9], v[10];
  const double off = (r.transpose() * r - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (!(off <= 1e-2) || r.determinant() < 0)
    refuse(file, line,
           "its 3x3 part is not a rotation (off by " + fixed(off, 3) +
               "): give a 3x4 matrix [R | t], row by row");
  return {r, Eigen::Vector3d(v[3], v[7], v[11])};
}

}  // namespace

Trajectory read_kitti(const Path& poses, const Path& times) {
  const FileBytes pose_bytes(poses), time_bytes(times);
  Trajectory result;
  Lines pose_lines(pose_bytes.view()), time_lines(time_bytes.view());
  std::array<double, 12> v;
  while (next_numbers(poses, pose_lines, ' ', v))
    result.T_world_frame.push_back(pose_of(poses, pose_lines.number(), v));
  std::array<double, 1> stamp;
  while (next_numbers(times, time_lines, ' ', stamp)) {
    require_later(times, time_lines.number(), result.stamps, stamp[0]);
    result.stamps.push_back(stamp[0]);
  }
  if (result.T_world_frame.empty()) refuse(poses, "holds no pose: give 12 numbers a line");
  if (result.stamps.size() != result.T_world_frame.size())
    refuse(times, "holds " + counted(result.stamps.size(), "stamps") + " for the " +
                      counted(result.T_world_frame.size(), "poses") + " of " + poses.string() +
                      ": give one for each pose");
  return result;
}

Trajectory read_mulran_csv(const Path& file) {
  const FileBytes bytes(file);
  Lines lines(bytes.view());
  Trajectory result;
  std::array<double, 13> v;
  while (next_numbers(file, lines, ',', v)) {
    // Nanoseconds since 1970 as a double are exact to 256 ns, as the stamp in seconds is.
    const double stamp = v[0] * 1e-9;
    require_later(file, lines.number(), result.stamps, stamp);
    result.stamps.push_back(stamp);
    result.T_world_frame.push_back(
        pose_of(file, lines.number(), std::span<const double, 12>(v.data() + 1, 12)));
  }
  if (result.stamps.empty())
    refuse(file, "holds no pose: give lines of 'stamp[ns], r11, r12, r13, x, ...' with 13 numbers");
  return result;
}

std::string kitti_text(const Trajectory& trajectory) {
  std::string text;
  text.reserve(170 * trajectory.size());
  for (const auto& pose : trajectory.T_world_frame) {
    const Eigen::Matrix3d r = pose.matrix();
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) text += fixed(r(row, column), 9) + ' ';
      text += fixed(pose.translation[row], 9) + (row < 2 ? ' ' : '\n');
    }
  }
  return text;
}

}  // namespace plumb
