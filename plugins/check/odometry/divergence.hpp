#pragma once
/// Where an odometry contradicts what the scans themselves say.

#include <functional>
#include <string>
#include <vector>

#include "plumb/plugin/context.hpp"
#include "plumb/slam/segment.hpp"
#include "plumb/slam/trajectory.hpp"
#include "scan_pair.hpp"

namespace plumb::check_odometry {

struct DivergenceOptions {
  ScanOptions scans;
  double min_path_length = 3;  ///< [m] path by the odometry between two scans that are compared, at
                               ///< least (a frame counts for no less than most do) ...
  std::uint32_t max_frames = 5;   ///< ... or so many frames
  double max_misfit_ratio = 0.5;  ///< another motion must fit so much better
  double min_translation = 0.7;   ///< [m] by which it must differ, or ...
  double min_rotation = 0.17;     ///< [rad]
  double single_factor = 4;       ///< a single pair counts only where it differs by so much more:
                                  ///< several in a row do not err by chance
};

/// Consecutive frames first .. last between which the odometry is contradicted.
struct Divergence {
  std::uint32_t first = 0, last = 0;
  double odometry_path = 0, registered_path = 0;  ///< [m]
  double odometry_turn = 0, registered_turn = 0;  ///< [rad] sums of the angles
  double translation_off = 0, rotation_off = 0;   ///< [m], [rad] greatest difference of one motion
};

struct CheckedOdometry {
  Trajectory trajectory;  ///< with the scans' motions in the place of those that they contradict
  std::vector<Divergence> divergences;
  std::uint32_t compared = 0;
};

/// Compares scans `min_path_length` or `max_frames` apart. For each pair the odometry's motion is
/// held against others: the motion before it, twice and half of it, none. Where one of them fits
/// better by far, both are aligned (ICP); where it still does, it takes the odometry's place, and
/// the next pair is held against it too. `open(k)` gives frame k; it is called from several
/// threads. Ours.
CheckedOdometry check_odometry(const Trajectory& odometry,
                               const std::function<std::shared_ptr<const Frame>(std::size_t)>& open,
                               const DivergenceOptions& options, Context& context);

/// "stands still", "has 2.0 times the path", "jumps by 50.0 m", "turns by 90 deg": what a
/// divergence looks like.
std::string kind_of(const Divergence& divergence);

}  // namespace plumb::check_odometry
