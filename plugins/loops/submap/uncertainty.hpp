#pragma once
/// How uncertain one segment's pose is as seen from another: it grows with the way between them
/// along the graph.

#include <vector>

#include "plumb/data/graph.hpp"

namespace plumb {

/// The graph of consecutive segments and of the loops that are known.
class Paths {
 public:
  /// `turn_length` [m/rad]: a turn counts as so much way. A loop counts as `loop_length` [m].
  Paths(const Poses& poses, const Constraints* loops, double turn_length, double loop_length);

  /// Travelled from the first segment to each [m].
  const std::vector<double>& travelled() const { return travelled_; }
  /// The shortest way from one segment to each, over loops too [m].
  std::vector<double> from(std::size_t segment) const;

 private:
  struct Step {
    std::uint32_t to;
    double length;
  };
  std::vector<double> travelled_;
  std::vector<std::vector<Step>> steps_;
};

}  // namespace plumb
