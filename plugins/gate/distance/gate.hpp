#pragma once
/// Which scans of a sequence belong to its chain: those whose centre lies about as far off as that
/// of the one before.

#include <optional>
#include <vector>

#include "plumb/slam/graph.hpp"

namespace plumb::gate_distance {

/// What the gate sees of a scan.
struct Seen {
  double range = 0;  ///< [m] from the sensor to the mean of the scan's points
  std::size_t points = 0;
  double begin = 0,
         end = 0;  ///< [s] stamps of its first and last frame; all 0 where no trajectory is given
};

struct GateOptions {
  double limit = 0.1;             ///< greatest change that is accepted
  std::uint32_t patience = 5;     ///< so many dropped in a row, then the window starts again
  std::uint32_t min_points = 10;  ///< scans with fewer are dropped
  std::optional<double> max_time_gap = 5;  ///< [s] without a scan, then the window starts again
};

struct Gated {
  Edges edges;
  std::size_t accepted = 0;  ///< scans, with the first ones of windows
  std::size_t far = 0;       ///< dropped because they changed too much
  std::size_t empty = 0;     ///< dropped because they have too few points
  std::size_t resets = 0;    ///< windows that started again
  std::size_t gaps = 0;      ///< of these, those after a stretch without scans
};

/// (r0 - r1)^2 / (r0 + r1)^2, without unit, 0 to 1; 0 where both are 0. [Zhang2023] eq. 13.
double change_of(double r0, double r1);

/// The chain of the accepted scans. A scan is accepted when it has enough points and its change
/// from the last accepted one is at most the limit. Each accepted scan is joined to the accepted
/// one before it, kind sequential. When `patience` scans were dropped for their change since the
/// last accepted one, the next that would be begins a new window: it is accepted and joined to the
/// last of the old one, kind neighbour. So does the first scan after a stretch without scans that
/// is longer than `max_time_gap` and than `patience` usual ones (their median), since frames that
/// were lost before the log are frames lost. The first scan with enough points begins the first
/// window.
Gated gated_chain(const std::vector<Seen>& scans, const GateOptions& options);

}  // namespace plumb::gate_distance
