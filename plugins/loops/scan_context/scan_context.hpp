#pragma once
/// A place as a sensor sees it from there: the greatest height in each ring and sector round it.

#include <Eigen/Core>

#include "plumb/slam/segment.hpp"

namespace plumb::loops_scan_context {

struct ContextOptions {
  std::uint32_t rings = 20;
  std::uint32_t sectors = 60;
  double max_range = 80;     ///< [m] the outermost ring's outer radius
  double sensor_height = 2;  ///< [m] above the ground, where heights begin

  /// As parameters of a step.
  template <class Declare>
  static void describe(Declare& is) {
    is.param("rings", &ContextOptions::rings)
        .range(2, 1000)
        .doc("rings round the sensor, equally wide")
        .source("[Kim2018] III.A");
    is.param("sectors", &ContextOptions::sectors)
        .range(4, 1000)
        .doc("sectors round the sensor; a heading is found to within one")
        .source("[Kim2018] III.A");
    is.param("max_range", &ContextOptions::max_range)
        .unit("m")
        .range(1, 1000)
        .doc("points farther from the segment's frame are left out")
        .source("[Kim2018] III.A");
    is.param("sensor_height", &ContextOptions::sensor_height)
        .unit("m")
        .range(0, 100)
        .doc("height of the sensor above the ground; lower points count as ground");
  }
};

/// Rings are rows, sectors columns.
struct ScanContext {
  Eigen::MatrixXf columns;   ///< heights above ground; each column is scaled to length 1, or 0
  Eigen::VectorXf ring_key;  ///< of each ring the share of sectors in which it holds a point
  std::vector<bool> filled;  ///< which columns hold something above ground
};

/// The context round the segment's frame, in axes of the world, so that a tilted sensor sees level
/// rings. Points with a non-finite coordinate are left out. Source: [Kim2018], eq. 1 to 4.
ScanContext scan_context(const Cloud& cloud, const Pose& T_world_segment,
                         const ContextOptions& options);

/// 1 less the distance of [Kim2018], eq. 6 and 7: the mean cosine of the columns, under the turn by
/// whole sectors under which it is greatest; 0 to 1, the same both ways but for rounding. Columns
/// that are empty in both do not count, those empty in one count 0 (ours). Contexts of the same
/// options.
double similarity(const ScanContext& a, const ScanContext& b);

}  // namespace plumb::loops_scan_context
