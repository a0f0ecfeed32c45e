#include "kmeans.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>

namespace plumb::prune_kmeans {
namespace {

/// k-means++: each next seed is drawn with a chance that goes with its squared distance to the
/// seeds so far.
std::vector<Vector6d> seeds(const std::vector<Vector6d>& vectors, std::uint32_t k, Random& random) {
  std::vector<Vector6d> chosen{vectors[random.below(static_cast<std::uint32_t>(vectors.size()))]};
  std::vector<double> squared(vectors.size(), std::numeric_limits<double>::infinity());
  while (chosen.size() < k) {
    for (std::size_t n = 0; n < vectors.size(); ++n)
      squared[n] = std::min(squared[n], (vectors[n] - chosen.back()).squaredNorm());
    double left = random.uniform() * std::accumulate(squared.begin(), squared.end(), 0.0);
    std::size_t next = vectors.size();
    for (std::size_t n = 0; n < vectors.size() && left >= 0; ++n) {
      if (squared[n] > 0) next = n;
      left -= squared[n];
    }
    if (next == vectors.size()) break;  // no vector differs from all seeds
    chosen.push_back(vectors[next]);
  }
  return chosen;
}

/// Moves each vector to its nearest centre; false if none moved.
bool assign(const std::vector<Vector6d>& vectors, Clusters& clusters) {
  bool moved = false;
  for (std::size_t n = 0; n < vectors.size(); ++n) {
    double nearest = std::numeric_limits<double>::infinity();
    std::uint32_t best = 0;
    for (std::uint32_t c = 0; c < clusters.centres.size(); ++c) {
      const double squared = (vectors[n] - clusters.centres[c]).squaredNorm();
      if (squared < nearest) nearest = squared, best = c;
    }
    moved |= best != clusters.of[n];
    clusters.of[n] = best;
  }
  return moved;
}

void move_centres(const std::vector<Vector6d>& vectors, Clusters& clusters) {
  std::vector<Vector6d> sums(clusters.centres.size(), Vector6d::Zero());
  std::vector<std::size_t> counts(clusters.centres.size(), 0);
  for (std::size_t n = 0; n < vectors.size(); ++n) {
    sums[clusters.of[n]] += vectors[n];
    ++counts[clusters.of[n]];
  }
  for (std::size_t c = 0; c < sums.size(); ++c)
    if (counts[c] > 0) clusters.centres[c] = sums[c] / static_cast<double>(counts[c]);
}

}  // namespace

Clusters kmeans(const std::vector<Vector6d>& vectors, std::uint32_t k, Random random) {
  constexpr int most_rounds = 100;
  Clusters clusters;
  if (vectors.empty() || k == 0) return clusters;
  clusters.centres = seeds(vectors, k, random);
  clusters.of.assign(vectors.size(), 0);
  assign(vectors, clusters);
  for (int round = 0; round < most_rounds; ++round) {
    move_centres(vectors, clusters);
    if (!assign(vectors, clusters)) break;
  }
  return clusters;
}

std::vector<std::uint32_t> best_cluster(const Clusters& clusters,
                                        const std::vector<Vector6d>& vectors, Keep keep,
                                        double min_spread, std::uint32_t min_pairs) {
  std::vector<double> counts(clusters.centres.size(), 0), spreads(clusters.centres.size(), 0);
  for (std::size_t n = 0; n < vectors.size(); ++n) {
    counts[clusters.of[n]] += 1;
    spreads[clusters.of[n]] += (vectors[n] - clusters.centres[clusters.of[n]]).squaredNorm();
  }
  // Worth first by the rule, then by count, then by tightness; a lower cluster wins among equals.
  std::uint32_t best = 0;
  std::tuple<double, double, double> best_worth(-1, 0, 0);
  for (std::uint32_t c = 0; c < counts.size(); ++c) {
    const double spread = counts[c] > 0 ? std::sqrt(spreads[c] / counts[c]) : 0;
    const double density = keep == Keep::densest && counts[c] >= min_pairs
                               ? counts[c] / std::pow(spread + min_spread, 2)
                               : 0;
    const std::tuple worth(density, counts[c], -spread);
    if (worth > best_worth) best_worth = worth, best = c;
  }
  std::vector<std::uint32_t> members;
  for (std::uint32_t n = 0; n < vectors.size(); ++n)
    if (clusters.of[n] == best) members.push_back(n);
  return members;
}

}  // namespace plumb::prune_kmeans
