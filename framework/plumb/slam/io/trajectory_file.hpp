#pragma once
/// Trajectories in files: TUM, KITTI poses, CSV of MulRan.

#include <filesystem>
#include <string>
#include <string_view>

#include "plumb/slam/trajectory.hpp"

namespace plumb {

/// Whether each stamp of a file must be later than the one before, or may step back, as in a log
/// whose clock did and in what is written from it.
enum class StampOrder { later, any };

/// Reads `stamp tx ty tz qx qy qz qw` lines (comments with #). Quaternions are normalised.
/// Throws Error with file:line for: cannot be opened, fewer or more than 8 numbers, text that is no
/// number, NaN, a quaternion of norm 0, a position more than 1e8 m off, no pose at all and, unless
/// any `order` will do, a stamp that is not later than the one before.
Trajectory read_tum(const std::filesystem::path& file, StampOrder order = StampOrder::later);

/// The same of a text; `file` is for sentences.
Trajectory parse_tum(std::string_view text, const std::filesystem::path& file,
                     StampOrder order = StampOrder::later);

/// Reads KITTI poses (12 numbers a line, a 3x4 matrix world_T_camera or world_T_frame) with the
/// stamps of `times`, one a line. Throws Error as read_tum, and when the two files differ in length
/// or a rotation is not orthonormal to 1e-2.
Trajectory read_kitti(const std::filesystem::path& poses, const std::filesystem::path& times);

/// Reads MulRan's global_pose.csv: `stamp[ns], r11, ..., r34` lines. Errors as read_kitti.
Trajectory read_mulran_csv(const std::filesystem::path& file);

/// The pose at time `stamp` [s], interpolated between the two poses round it. Throws Error when
/// `stamp` lies outside by more than `slack` [s].
Pose pose_at(const Trajectory& trajectory, double stamp, double slack);

/// TUM lines: stamp with 6 decimals (or as many as tell neighbouring stamps apart), positions and
/// quaternions with 9.
std::string tum_text(const Trajectory& trajectory);

/// KITTI lines, 12 numbers each.
std::string kitti_text(const Trajectory& trajectory);

}  // namespace plumb
