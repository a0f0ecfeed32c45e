#pragma once
/// How uncertain one segment's pose is as seen from another: it grows with the path between them
/// along the graph.

#include <vector>

#include "plumb/slam/graph.hpp"

namespace plumb::loops_submap {

/// The graph of consecutive segments and of the loops that are known.
class Paths {
 public:
  /// `turn_length` [m/rad]: path length that a rotation counts as. A loop counts as `loop_length`
  /// [m].
  Paths(const Poses& poses, const Constraints* loops, double turn_length, double loop_length);

  /// Travelled from the first segment to each [m].
  const std::vector<double>& travelled() const { return travelled_; }
  /// Length of the shortest path from one segment to each, over loops too [m].
  std::vector<double> from(std::size_t segment) const;

 private:
  struct Step {
    std::uint32_t to;
    double length;
  };
  std::vector<double> travelled_;
  std::vector<std::vector<Step>> steps_;
};

}  // namespace plumb::loops_submap
