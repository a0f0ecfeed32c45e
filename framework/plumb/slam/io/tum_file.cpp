/// TUM trajectories: `stamp tx ty tz qx qy qz qw` lines.

#include <array>
#include <charconv>
#include <cmath>

#include "plumb/data/io/file_kind.hpp"
#include "plumb/data/io/file_text.hpp"
#include "plumb/slam/io/trajectory_file.hpp"
#include "plumb/slam/io/trajectory_text.hpp"

namespace plumb {

using namespace io;

namespace {

constexpr double farthest = 1e8;  // [m] from the origin; UTM coordinates stay below 1e7

}  // namespace

Trajectory read_tum(const std::filesystem::path& file, StampOrder order) {
  return parse_tum(io::FileBytes(file).view(), file, order);
}

Trajectory parse_tum(std::string_view text, const std::filesystem::path& file, StampOrder order) {
  const std::string kind = kind_of_content(text);
  if (!kind.empty() && kind != "a trajectory (TUM)" && kind != "lines of numbers")
    refuse(file, "is not a TUM trajectory, it looks like " + kind +
                     ": give a text file with a line 'stamp tx ty tz qx qy qz qw' for each pose, "
                     "as a run's trajectory.tum");
  Lines lines(text);
  Trajectory result;
  std::array<double, 8> v;
  while (next_numbers(file, lines, ' ', v)) {
    Eigen::Quaterniond q(v[7], v[4], v[5], v[6]);
    const double norm = q.coeffs().stableNorm();
    if (!(norm > 1e-6))
      refuse(
          file, lines.number(),
          "the quaternion has norm 0, so it is not a rotation: correct the line (no rotation is 0 "
          "0 0 1)");
    if (!std::isfinite(norm))
      refuse(file, lines.number(), "the quaternion is too large: its norm is 1; correct the line");
    q.coeffs() /= norm;
    for (std::size_t k = 1; k < 4; ++k)
      if (std::abs(v[k]) > farthest)
        refuse(file, lines.number(),
               "the position " + fixed(v[k], 0) +
                   " m is farther off than anything on Earth: correct the line");
    if (order == StampOrder::later) require_later(file, lines.number(), result.stamps, v[0]);
    result.stamps.push_back(v[0]);
    result.T_world_frame.emplace_back(q, Eigen::Vector3d(v[1], v[2], v[3]));
  }
  if (result.stamps.empty())
    refuse(file, "holds no pose: give one line a frame, 'stamp tx ty tz qx qy qz qw'");
  return result;
}

std::string tum_text(const Trajectory& trajectory) {
  int decimals = 6;
  for (std::size_t k = 1; k < trajectory.size(); ++k)
    while (decimals < 15 &&
           fixed(trajectory.stamps[k - 1], decimals) == fixed(trajectory.stamps[k], decimals))
      ++decimals;
  std::string text;
  text.reserve(110 * trajectory.size());
  for (std::size_t k = 0; k < trajectory.size(); ++k) {
    const Pose& pose = trajectory.T_world_frame[k];
    text += fixed(trajectory.stamps[k], decimals);
    for (const double t : pose.translation) text += ' ' + fixed(t, 9);
    for (const double q : pose.rotation.coeffs()) text += ' ' + fixed(q, 9);
    text += '\n';
  }
  return text;
}

}  // namespace plumb
