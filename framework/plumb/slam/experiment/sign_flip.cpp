#include "plumb/slam/experiment/sign_flip.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include "plumb/data/random.hpp"

namespace plumb::experiment {
namespace {

/// By the bits of its number, the subset {} left out.
std::vector<double> means_of_all_subsets(const std::vector<double>& values) {
  const std::size_t n = std::size_t{1} << values.size();
  std::vector<double> sums(n);
  for (std::size_t set = 1; set < n; ++set)
    sums[set] = sums[set & (set - 1)] + values[static_cast<std::size_t>(std::countr_zero(set))];
  for (std::size_t set = 1; set < n; ++set) sums[set] /= std::popcount(set);
  sums.erase(sums.begin());
  return sums;
}

std::vector<double> means_of_drawn_subsets(const std::vector<double>& values, std::size_t subsets) {
  Random random(1);
  std::vector<double> means;
  while (means.size() < subsets) {
    double sum = 0, n = 0;
    std::uint64_t bits = 0;
    for (std::size_t k = 0; k < values.size(); ++k, bits >>= 1) {
      if (k % 64 == 0) bits = random.next();
      if (bits & 1) sum += values[k], ++n;
    }
    if (n > 0) means.push_back(sum / n);
  }
  return means;
}

}  // namespace

SignFlip::SignFlip(const std::vector<double>& differences)
    : means_(differences.size() <= most_exact ? means_of_all_subsets(differences)
                                              : means_of_drawn_subsets(differences, drawn_subsets)),
      mean_(std::accumulate(differences.begin(), differences.end(), 0.0) /
            static_cast<double>(differences.size())),
      rounding_(0) {
  std::ranges::sort(means_);
  for (const double difference : differences)
    rounding_ = std::max(rounding_, 1e-12 * std::abs(difference));
}

double SignFlip::p() const {
  if (std::abs(mean_) <= rounding_) return 1;
  const auto beyond = mean_ > 0 ? std::ranges::upper_bound(means_, rounding_) - means_.begin()
                                : means_.end() - std::ranges::lower_bound(means_, -rounding_);
  return std::min(1.0, (1 + static_cast<double>(beyond)) * least_p());
}

std::optional<Interval> SignFlip::interval(double alpha) const {
  const double sets = static_cast<double>(means_.size()) + 1;
  const auto k = static_cast<std::size_t>(alpha / 2 * sets + 1e-9);
  if (k < 1 || k > means_.size()) return std::nullopt;
  return Interval{means_[k - 1], means_[means_.size() - k]};
}

std::size_t differences_needed(double alpha, std::size_t comparisons) {
  std::size_t n = 1;
  while (2 * static_cast<double>(comparisons) > alpha * std::ldexp(1.0, static_cast<int>(n))) ++n;
  return n;
}

std::vector<double> holm(const std::vector<double>& p) {
  std::vector<std::size_t> order(p.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t k) { return p[k]; });
  std::vector<double> adjusted(p.size());
  double most = 0;
  for (std::size_t rank = 0; rank < order.size(); ++rank) {
    const auto left = static_cast<double>(p.size() - rank);
    most = std::max(most, std::min(1.0, left * p[order[rank]]));
    adjusted[order[rank]] = most;
  }
  return adjusted;
}

}  // namespace plumb::experiment
