#pragma once
/// What paired differences prove: the exact sign-flip (permutation) test, and the interval that
/// goes with it.

#include <cstdint>
#include <optional>
#include <vector>

namespace plumb::experiment {

struct Interval {
  double low = 0, high = 0;
};

/// The test of "no difference" for differences of which each is as likely to have the other sign,
/// if there is none: independent, symmetric, of any distribution and of unequal spread.
///
/// What decides are the means over all non-empty subsets of the differences. Flipping the signs of
/// a set S gives a mean at least as far off as the one seen, on its side, exactly when the mean
/// over S lies on the other side of 0; so p = 2 (1 + n) / 2^N with n the number of subsets whose
/// mean does. The values that are not refuted at level a lie between the k-th smallest and the k-th
/// largest of those means, k = floor(a 2^N / 2): the interval is the inversion of the test, and
/// they agree always. Source: Fisher 1935 for the test, Hartigan 1969 (typical values) for the
/// subsets.
class SignFlip {
 public:
  static constexpr std::size_t most_exact = 20;  ///< differences, of which all subsets are taken
  static constexpr std::size_t drawn_subsets = 99999;  ///< of more differences, by a fixed seed

  /// Of one difference or more.
  explicit SignFlip(const std::vector<double>& differences);

  double mean() const { return mean_; }
  double p() const;  ///< two-sided
  /// The least p that so many differences can have.
  double least_p() const { return 2 / (static_cast<double>(means_.size()) + 1); }
  /// At confidence 1 - `alpha`; nothing where the differences are too few for any.
  std::optional<Interval> interval(double alpha = 0.05) const;

 private:
  std::vector<double> means_;  ///< over subsets, rising
  double mean_, rounding_;     ///< of all; below which a mean counts as 0
};

/// Fewest differences of which `comparisons` could be shown at once at level `alpha` (Holm): 6 for
/// one at 0.05.
std::size_t differences_needed(double alpha, std::size_t comparisons);

/// p values of several comparisons, adjusted so that all that are at most alpha are right together
/// with probability 1 - alpha. Source: Holm 1979.
std::vector<double> holm(const std::vector<double>& p);

}  // namespace plumb::experiment
