#pragma once
/// Which loops agree with each other and with the odometry.

#include <vector>

#include "plumb/slam/graph.hpp"

namespace plumb::prune_loop_consistency {

/// How far the poses may have drifted between two segments with path L between them. Errors are
/// slow: over `correlation_length` they add up in proportion to the path, beyond it with its root.
struct DriftModel {
  double translation_per_metre = 0.01;     ///< [m/m]
  double rotation_per_metre = 0.03 * deg;  ///< [rad/m]
  double correlation_length = 100;         ///< [m]

  /// Standard deviations of the rotation [rad] and of the position [m] over `path` [m], the ends
  /// `distance` [m] apart.
  double rotation(double path) const;
  double position(double path, double distance) const;
};

/// A registered loop: segment j is where T_i_j says, seen from i.
struct Loop {
  std::uint32_t i = 0, j = 0;
  Pose T_i_j;
  double sigma_translation = 0.1, sigma_rotation = 0.005;  ///< of its own [m], [rad]
};

enum class LoopVerdict : std::uint8_t { kept, against_odometry, against_loops, undecided, alone };

struct ConsistencyOptions {
  DriftModel drift;
  double max_deviation = 3.5;  ///< standard deviations within which things agree
  double min_agreement =
      0.6;  ///< share of the other loops, of those that can tell, that must agree with a loop
  double max_rival_share = 0.5;  ///< rejected loops that contradict a kept one and agree with
                                 ///< another, as a share of those that agree with it: above it
                                 ///< none is kept
  double max_path_separation =
      150;  ///< [m] path at either end within which two loops can tell something of each other
  double max_unconfirmed_sigma = 3;  ///< [m] a loop that no other can confirm is kept where the
                                     ///< drift's deviation is at most this
};

/// A verdict for each loop. First those that no drift within `max_deviation` explains are dropped.
/// Then two loops that lie near each other at both ends are compared round their cycle i_a j_a j_b
/// i_b: with the little path between them the poses are nearly exact, so right loops agree to
/// decimetres. While some loop agrees with less than `min_agreement` of its neighbours, the one
/// that agrees with the smallest share is dropped. Where those that were dropped agree with each
/// other and are not much fewer than those that stay, neither side is believed: both may be streets
/// that look alike. Source: pairwise consistency, Mangelson et al.
/// 2018 (PCM), with covariances that grow with the path.
std::vector<LoopVerdict> judge_loops(const std::vector<Loop>& loops, const Poses& poses,
                                     const ConsistencyOptions& options);

}  // namespace plumb::prune_loop_consistency
