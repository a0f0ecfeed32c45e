#pragma once
/// The consistency check of loops: what one loop says, others nearby must say too.

#include <vector>

#include "plumb/slam/graph.hpp"

namespace plumb::loops_submap {

struct SupportOptions {
  std::uint32_t min_support = 1;  ///< others that must agree; 0: all are kept
  double within = 10;             ///< [m] of path at each end within which others are compared
  double max_disagreement = 0.3;  ///< [m], a third of it in rad: how far two may differ
  double per_metre = 0.02;        ///< added for each metre of path between their ends
};

/// The loops that at least `support` others agree with. Two loops (i, j) and (k, l) whose ends are
/// near each other along the path close a cycle T_i_j T_j_l T_l_k T_k_i with two short pieces of
/// the trajectory, which must come back to where it began. Source: cycle consistency as in
/// [Mangelson2018], between neighbours alone. Order is kept. O(n times neighbours).
std::vector<RelativePose> supported(const std::vector<RelativePose>& loops, const Poses& poses,
                                    const SupportOptions& options);

}  // namespace plumb::loops_submap
