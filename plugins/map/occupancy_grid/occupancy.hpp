#pragma once
/// Occupancy of a plane from laser scans whose poses are known. Source: [Moravec1985], [Thrun2005]
/// ch. 9.

#include <string>
#include <vector>

#include "plumb/slam/values.hpp"
#include "shared/parallel/loop.hpp"

namespace plumb::map_occupancy_grid {

/// A scan in world coordinates [m].
struct PlacedScan {
  Eigen::Vector2d from;  ///< the sensor
  std::vector<Eigen::Vector2d> hits;
};

/// The points of `cloud` by its sensor's pose, seen from above.
PlacedScan placed(const Cloud& cloud, const Pose& T_world_sensor);

struct GridOptions {
  double resolution = 0.05;   ///< edge of a cell [m]
  double hit = 0.85;          ///< added to the log odds of a cell with a hit
  double miss = 0.4;          ///< taken off the log odds of a cell that a ray passes
  double min_log_odds = -2;   ///< log odds stay from here
  double max_log_odds = 3.5;  ///< to here
  double max_range = 30;      ///< a ray that ends farther away only clears its way up to here [m]
  std::size_t max_cells = 400'000'000;

  std::string check() const {
    return min_log_odds < 0 && max_log_odds > 0
               ? ""
               : "min_log_odds must be below 0 and max_log_odds above 0, since 0 means not seen";
  }
};

/// The map of all scans, taken in their order. In each scan a cell counts once: as hit if any ray
/// ends in it, else as missed if any ray passes it. A cell that was seen is never 0. The same bytes
/// for any number of threads. Without scans an empty map. Throws Error: more than `max_cells`, a
/// place that is no number.
GridMap occupancy(const std::vector<PlacedScan>& scans, const GridOptions& options,
                  const parallel::Loop& parallel);

}  // namespace plumb::map_occupancy_grid
