#pragma once
/// Loops by registering a submap of the newest scans to the map of earlier ones. Source:
/// [Zhang2023] 1; which places are tried, the search and what is accepted are ours.

#include <functional>
#include <memory>

#include "plumb/plugin/context.hpp"
#include "plumb/slam/graph.hpp"
#include "plumb/slam/segment.hpp"

namespace plumb::loops_submap {

struct LoopOptions {
  std::uint32_t submap_segments = 10;  ///< segments in a submap, the current one the last
  std::uint32_t map_segments = 12;     ///< segments of the map on each side of the candidate
  double stride = 1.5;                 ///< [m] of path between two submaps that are searched for
  double min_path_separation = 8;      ///< [m] of path between a submap and a candidate
  double turn_length = 0.3;            ///< [m/rad] path length that a rotation counts as
  double max_distance =
      2;  ///< [m] submaps that passed closer than this, plus the uncertainty, are candidates
  double drift = 0.04;  ///< [m/m] standard deviations of the place, three of them, after one metre
  double heading_drift = 0.25 * deg;   ///< [rad/m] the same of the heading
  double max_search_window = 5;        ///< [m] the uncertainty never counts as more
  double max_search_angle = 35 * deg;  ///< [rad]
  std::uint32_t max_places = 4;  ///< earlier visits that a submap is registered to, the nearest
  double resolution = 0.1;       ///< [m] of the search
  double max_range = 15;  ///< [m] points farther from the submap's or the map's centre are left out
  double min_score = 0.55;  ///< of the peak
  double max_second_peak =
      0.95;  ///< another peak this high, as a share of the first, makes it ambiguous
  double min_peak_distance = 0.6;  ///< [m] and 0.25 rad: so far another peak lies at least
  std::uint32_t min_support = 2;   ///< loops nearby that must say the same
  double max_disagreement = 0.3;   ///< [m] (and a third of it in rad): difference of two loops that
                                   ///< agree, plus 2 % of the path between
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

}  // namespace plumb::loops_submap
