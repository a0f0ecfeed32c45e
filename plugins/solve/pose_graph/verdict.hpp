#pragma once
/// What the solved graph says of itself: numbers, each edge's status, and what is weak.

#include "edge_state.hpp"

namespace plumb::solve_pose_graph {

/// Mean weight from which an edge counts as accepted, and under which as rejected; between them it
/// is down-weighted.
inline constexpr double accepted_from = 0.5, rejected_under = 0.05;
const char* status_of(double mean_weight);

class Verdict {
 public:
  explicit Verdict(std::size_t poses) : support_(poses, 0.0) {}
  void add(const EdgeState& edge);
  /// A constraint with the distance [m] that is left, and its robust weight.
  void add(const RelativePose& constraint, bool sequential, double residual, double weight);
  /// Poses in order that nothing names, as of dropped scans: they are a note, not parts of their
  /// own.
  void left_out(std::vector<std::uint32_t> poses) { left_out_ = std::move(poses); }
  void joined_by_prior() { prior_ = true; }

  Metrics metrics(double cost_before, double cost_after, int rounds, int iterations);
  /// One sentence if the graph falls apart.
  std::vector<std::string> warnings(std::vector<std::vector<std::uint32_t>> parts) const;

 private:
  std::vector<std::string> notes() const;
  void drop_left_out(std::vector<std::vector<std::uint32_t>>& parts) const;

  std::vector<EdgeRecord> records_;
  std::vector<double> support_;  ///< of each pose: pairs that hold it, by weight
  std::vector<std::uint32_t> left_out_;
  double squares_ = 0, weights_ = 0;
  std::uint64_t pairs_ = 0;
  bool constraints_ = false, prior_ = false;
};

}  // namespace plumb::solve_pose_graph
