#include "consensus.hpp"

#include <algorithm>

#include "shared/point_pairs/compatibility.hpp"
#include "shared/point_pairs/rigid_fit.hpp"
#include "shared/selection/evenly.hpp"

namespace plumb::register_features {
namespace {

/// Fits again to who agrees, as long as their number grows.
Consensus grown(const Matches& matches, std::vector<std::uint32_t> pairs, double tolerance) {
  Consensus best;
  for (int round = 0; round < 10 && pairs.size() >= 3; ++round) {
    Consensus next{point_pairs::rigid_fit(matches.p, matches.q, pairs), {}};
    next.inliers = point_pairs::agreeing(matches.p, matches.q, next.T_j_i, tolerance);
    if (next.inliers.size() <= best.inliers.size()) break;
    pairs = next.inliers;
    best = std::move(next);
  }
  if (best.inliers.size() >= 3)
    best.T_j_i = point_pairs::rigid_fit(matches.p, matches.q, best.inliers);
  return best;
}

}  // namespace

Consensus consensus_of(const Matches& matches, const ConsensusOptions& options) {
  Consensus best;
  const std::vector<std::uint32_t> chosen = selection::evenly(matches.size(), options.max_pairs);
  const std::size_t n = chosen.size();
  if (n < 3) return best;
  const point_pairs::BitGraph graph = point_pairs::compatibility_of(
      matches.p, matches.q, chosen, options.tolerance, options.min_length);
  std::vector<std::pair<std::uint32_t, std::uint32_t>> order(n);  // most compatible first
  for (std::uint32_t a = 0; a < n; ++a) order[a] = {graph.degree(a), a};
  std::ranges::sort(order, [](const auto& a, const auto& b) {
    return std::pair(-static_cast<std::int64_t>(a.first), a.second) <
           std::pair(-static_cast<std::int64_t>(b.first), b.second);
  });
  constexpr std::size_t sample = 12;
  for (std::size_t s = 0; s < std::min<std::size_t>(n, options.seeds); ++s) {
    const std::uint32_t seed = order[s].second;
    if (order[s].first < 3) break;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> friends;
    for (std::uint32_t b = 0; b < n; ++b)
      if (graph.joined(seed, b)) friends.emplace_back(graph.common(seed, b), b);
    const std::size_t few = std::min(sample, friends.size());
    std::ranges::partial_sort(friends, friends.begin() + static_cast<std::ptrdiff_t>(few),
                              [](const auto& a, const auto& b) {
                                return std::pair(-static_cast<std::int64_t>(a.first), a.second) <
                                       std::pair(-static_cast<std::int64_t>(b.first), b.second);
                              });
    std::vector<std::uint32_t> pairs{chosen[seed]};
    for (std::size_t k = 0; k < few; ++k) pairs.push_back(chosen[friends[k].second]);
    Consensus one = grown(matches, std::move(pairs), options.tolerance);
    if (one.inliers.size() > best.inliers.size()) best = std::move(one);
  }
  return best;
}

}  // namespace plumb::register_features
