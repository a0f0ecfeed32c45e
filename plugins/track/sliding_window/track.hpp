#pragma once
/// Tracks a 2-D laser: registers each scan to the submap of those before it. Source: the window is
/// that of [Zhang2023] 2, where adjacent scans are registered to each other; to the submap is ours.

#include <span>

#include "plumb/slam/graph.hpp"
#include "submap.hpp"

namespace plumb::track_sliding_window {

using planar::IcpOptions;
using planar::Metric;
using planar::Stop;

struct TrackOptions : SubmapOptions {
  IcpOptions icp = {.stop = Stop::ratio, .metric = Metric::line};
  double min_translation =
      0.25;  ///< [m] a scan farther than this from the window's newest joins the window
  double min_rotation = 15 * deg;  ///< [rad] or rotated by more
  double min_overlap = 0.5;  ///< share of a scan's points that must have a partner for it to fit
  std::optional<double> search_below = 0.9;  ///< overlap below which the pose is searched for
  double search_blind = 0.98;                ///< the same where there is no odometry
  std::uint32_t patience = 5;  ///< scans that do not fit in a row, after which the window restarts
};

struct Tracked {
  Poses poses;  ///< of all scans; of those that the chain leaves out: between their neighbours
  std::size_t registered = 0;  ///< scans registered to a submap
  std::size_t unfit = 0;  ///< of these, those that did not fit: the motion that was expected stands
  std::size_t searched = 0;                     ///< of these, those whose pose was searched for
  std::size_t restarts = 0;                     ///< windows begun after the first one
  double iterations = 0, mae = 0, overlap = 0;  ///< sums over `registered`; mae [m]
};

/// `scans` in order, `initial` where they are as the odometry has it, `chain` from gate.distance:
/// each accepted scan and the one before; a kind other than sequential starts the window again,
/// after the scan was registered to the old one. Where the initial poses are all the same (there is
/// no odometry) the motion before is expected to go on, as if scans were evenly spaced: the stamps
/// of real logs come in bursts. Throws Error where sizes differ or the edges are no chain.
Tracked track(std::span<const Cloud* const> scans, const Poses& initial, const Edges& chain,
              const TrackOptions& options);

}  // namespace plumb::track_sliding_window
