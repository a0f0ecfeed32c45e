#pragma once
/// The rigid motion that most point pairs agree on, by random samples of three.

#include <cstdint>
#include <vector>

#include "plumb/plugin/context.hpp"
#include "plumb/slam/graph.hpp"

namespace plumb::prune_ransac {

struct RansacOptions {
  double max_correspondence_distance = 0.5;  ///< [m] an inlier has |p - T_i_j q| up to this
  /// Chance to have drawn a sample of inliers alone, after which drawing stops.
  double confidence = 0.999;
  std::uint32_t max_iterations = 50000;  ///< drawn at most
};

struct Consensus {
  Pose T_i_j;  ///< fitted to all inliers
  /// In order; empty if no sample of three fitted its own motion.
  std::vector<std::uint32_t> inliers;
  std::uint32_t samples = 0;  ///< drawn
};

/// Draws three pairs, drops them if their triangle's sides differ by more than 2
/// max_correspondence_distance or it is too small to tell a rotation, else fits a motion and counts
/// who agrees; the one with most (the first of equals) is fitted again to its inliers as long as
/// their number grows. Drawing stops when the share w of inliers makes a sample of inliers likely
/// enough: samples >= log(1 - confidence) / log(1 - w^3). Source: [Fischler1981]. The same `random`
/// gives the same result.
Consensus ransac(const Matches& matches, const RansacOptions& options, Random random);

}  // namespace plumb::prune_ransac
