#include "plumb/slam/experiment/bootstrap.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "plumb/data/random.hpp"

namespace plumb::experiment {
namespace {

using Pairs = std::vector<std::vector<RunPair>>;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t fewest_replicates = 3, fewest_segments = 2;

/// Between neighbours linearly, as numpy does by itself. `values` rise.
double quantile(const std::vector<double>& values, double q) {
  const double place = q * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, values.size() - 1);
  return values[below] + (values[above] - values[below]) * (place - static_cast<double>(below));
}

/// How often each of n was drawn in n draws.
std::vector<double> drawn(std::size_t n, Random& random) {
  std::vector<double> times(n, 0.0);
  for (std::size_t k = 0; k < n; ++k) ++times[random.below(static_cast<std::uint32_t>(n))];
  return times;
}

/// Weights of `size` segments, by their place among those that have `weights`.
std::vector<double> at_the_same_places(const std::vector<double>& weights, std::size_t size) {
  if (size == weights.size()) return weights;
  std::vector<double> all(size);
  for (std::size_t k = 0; k < size; ++k) all[k] = weights[k * weights.size() / size];
  return all;
}

double mean_with_segments_drawn(const std::vector<RunPair>& runs, Scale scale, Random& random) {
  const std::vector<double> weights = drawn(runs.front().of_a->size(), random);
  double sum = 0;
  for (const RunPair& run : runs)
    sum += contrast(scale, run.of_a->value(at_the_same_places(weights, run.of_a->size())),
                    run.of_b->value(at_the_same_places(weights, run.of_b->size())));
  return sum / static_cast<double>(runs.size());
}

double mean_with_replicates_drawn(const std::vector<RunPair>& runs, Scale scale, Random& random) {
  double sum = 0;
  for (std::size_t k = 0; k < runs.size(); ++k) {
    const RunPair& run = runs[random.below(static_cast<std::uint32_t>(runs.size()))];
    sum += contrast(scale, run.a, run.b);
  }
  return sum / static_cast<double>(runs.size());
}

Resampled what_to_draw(const Pairs& pairs) {
  bool segments = true, replicates = true;
  for (const auto& runs : pairs) {
    replicates = replicates && runs.size() >= fewest_replicates;
    for (const RunPair& run : runs)
      for (const SegmentSums* sums : {run.of_a, run.of_b})
        segments = segments && sums && sums->size() >= fewest_segments;
  }
  return segments ? Resampled::segments : replicates ? Resampled::replicates : Resampled::nothing;
}

}  // namespace

double contrast(Scale scale, double a, double b) {
  return scale == Scale::ratio ? std::log(b / a) : b - a;
}

double SegmentSums::value(const std::vector<double>& weights) const {
  double weighted = 0, total = 0;
  for (std::size_t k = 0; k < sum.size(); ++k) {
    weighted += weights[k] * sum[k];
    total += weights[k] * count[k];
  }
  if (total <= 0) return nan;
  return root ? std::sqrt(weighted / total) : weighted / total;
}

BootstrapInterval bootstrap(const Pairs& pairs, Scale scale, std::size_t draws, std::uint64_t seed,
                            double alpha) {
  const Resampled resampled = pairs.empty() ? Resampled::nothing : what_to_draw(pairs);
  if (resampled == Resampled::nothing) return {};
  Random random(seed);
  std::vector<double> means;
  // A draw that misses everything (no edge at any of its segments) gives no number and is repeated.
  for (std::size_t tries = 0; means.size() < draws && tries < 2 * draws; ++tries) {
    double sum = 0;
    for (const auto& runs : pairs)
      sum += resampled == Resampled::segments ? mean_with_segments_drawn(runs, scale, random)
                                              : mean_with_replicates_drawn(runs, scale, random);
    if (std::isfinite(sum)) means.push_back(sum / static_cast<double>(pairs.size()));
  }
  if (means.size() < draws) return {};
  std::ranges::sort(means);
  return {resampled, {quantile(means, alpha / 2), quantile(means, 1 - alpha / 2)}};
}

}  // namespace plumb::experiment
