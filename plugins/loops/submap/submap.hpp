#pragma once
/// Loops by laying the newest group of scans onto the map of earlier ones. Source: [Zhang2023] 1,
/// 2; the search is ours.

#include <functional>
#include <memory>

#include "plumb/data/graph.hpp"
#include "plumb/data/segment.hpp"
#include "plumb/plugin/context.hpp"

namespace plumb {

struct LoopOptions {
  std::uint32_t submap_segments = 10;  ///< segments that make a group, the asking one the last
  std::uint32_t map_segments =
      12;               ///< segments of the map on each side of the one that is asked about
  double stride = 1.5;  ///< [m] of way between two groups that ask
  double min_path_separation = 8;  ///< [m] of way that lies between a group and what it may meet
  double turn_length = 0.3;        ///< [m/rad] a turn counts as so much way
  double max_distance =
      2;  ///< [m] groups that passed closer than this, but for the uncertainty, may meet
  double drift = 0.04;  ///< [m/m] standard deviations of the place, three of them, after one metre
  double heading_drift = 0.25 * deg;   ///< [rad/m] the same of the heading
  double max_search_window = 5;        ///< [m] the uncertainty never counts as more
  double max_search_angle = 35 * deg;  ///< [rad]
  std::uint32_t max_places = 4;        ///< earlier visits that a group is laid onto, the nearest
  double resolution = 0.1;             ///< [m] of the search
  double max_range = 15;  ///< [m] points farther from the group's or the map's middle are left out
  double min_score = 0.55;  ///< of the peak
  double max_second_peak =
      0.95;  ///< another peak this high, as a share of the first, makes it ambiguous
  double min_peak_distance = 0.6;  ///< [m] and 0.25 rad: so far another peak lies at least
  std::uint32_t min_support = 2;   ///< loops nearby that must say the same
  double max_disagreement =
      0.3;  ///< [m] (and a third of it in rad): what 'the same' means, and 2 % of the way between
};

/// What was tried and what came of it.
struct LoopCounts {
  std::uint32_t asked = 0, tried = 0, low = 0, ambiguous = 0, alone = 0;
};

struct Loops {
  Constraints constraints;  ///< planar
  LoopCounts counts;
};

/// `open(k)` gives segment k, planar; `known`, if not null, loops found before: they make poses
/// less uncertain.
Loops find_loops(const std::function<std::shared_ptr<const Segment>(std::size_t)>& open,
                 const Poses& poses, const Constraints* known, const LoopOptions& options,
                 Context& context);

}  // namespace plumb
