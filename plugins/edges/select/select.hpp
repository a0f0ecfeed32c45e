#pragma once
/// Few edges out of many: what a graph needs to be firm, with a number of edges that grows with the
/// number of segments alone.

#include <optional>
#include <vector>

#include "plumb/slam/graph.hpp"

namespace plumb::edges_select {

struct SelectOptions {
  std::optional<double> max_path_separation;  ///< [m] path between the two ends, at most; none: any
  std::uint32_t max_along = 4;  ///< partners of one visit before each segment, and as many after it
  std::uint32_t max_visits = 3;  ///< other visits of the place that each segment asks
  std::uint32_t per_visit = 2;   ///< partners in each of them
};

/// Edges that at least one end asks for, in the order of `edges`; sequential ones always stay.
///
/// The partners of a segment fall into runs of consecutive indices: the run that it lies in itself
/// is the visit under way, each other run is another visit of the same place. Of the visit under
/// way a segment asks for the partners next to 2, 3, 5, 8, 13 ... segments away (Fibonacci's
/// numbers), before and after: short reach for firmness, long reach against the sum of small
/// errors. Of each other visit it asks for the partners with the greatest score, visits with the
/// greatest scores first. So there are at most (2 max_along + max_visits per_visit) edges a segment
/// beside the sequential ones. `positions`: of the segments [m], in order of the path. Ours.
Edges select_edges(const Edges& edges, const std::vector<Eigen::Vector3d>& positions,
                   const SelectOptions& options);

}  // namespace plumb::edges_select
