#pragma once
/// How sure a difference is on the data at hand, where there are too few sequences to say more.

#include <cstdint>
#include <vector>

#include "plumb/slam/experiment/sign_flip.hpp"

namespace plumb::experiment {

/// How two values of a number are held against each other.
enum class Scale {
  ratio,       ///< by ln(b / a): errors, times, memory
  difference,  ///< by b - a: counts, and what may be 0 or negative
};
double contrast(Scale scale, double a, double b);

/// A number as what it is made of, by segment: a mean over all, or the root of one, so that it can
/// be taken again with other weights of the segments. An edge counts to both of its segments.
struct SegmentSums {
  bool root = false;
  std::vector<double> sum, count;  ///< by segment, in the order of the path

  std::size_t size() const { return sum.size(); }
  /// With so much weight on each segment; NaN when nothing has any.
  double value(const std::vector<double>& weights) const;
  double value() const { return value(std::vector<double>(size(), 1)); }
};

/// A number of two variants on one input in the same replicate.
struct RunPair {
  double a = 0, b = 0;
  const SegmentSums *of_a = nullptr, *of_b = nullptr;  ///< null where they are not known
};

/// What was drawn anew.
enum class Resampled { nothing, segments, replicates };

struct BootstrapInterval {
  Resampled resampled = Resampled::nothing;
  Interval interval;
};

/// Percentile interval, at confidence 1 - `alpha`, of the mean over the inputs of the mean contrast
/// over their replicates. In each draw the segments of every input are drawn with replacement, each
/// with all its frames or edges: the same for both variants and all replicates, by their place
/// along the path where these are cut otherwise. Where the segments of some run are not known,
/// replicates are drawn, if every input has at least three. `pairs`: by input, then replicate; none
/// is empty.
BootstrapInterval bootstrap(const std::vector<std::vector<RunPair>>& pairs, Scale scale,
                            std::size_t draws, std::uint64_t seed, double alpha = 0.05);

}  // namespace plumb::experiment
