#include "consistency.hpp"

#include <algorithm>

#include "clique.hpp"
#include "cores.hpp"
#include "shared/point_pairs/compatibility.hpp"
#include "shared/point_pairs/rigid_fit.hpp"
#include "shared/selection/evenly.hpp"

namespace plumb::prune_consistency {
namespace {

/// The pairs of the clique or the core, by their places among all.
std::vector<std::uint32_t> selected_pairs(const Matches& matches, const ConsistencyOptions& options,
                                          bool& largest) {
  const auto chosen = selection::evenly(matches.size(), options.max_pairs);
  const auto graph = point_pairs::compatibility_of(matches.p, matches.q, chosen,
                                                   2 * options.max_correspondence_distance);
  std::vector<std::uint32_t> vertices;
  if (options.select == Select::core) {
    vertices = innermost_core(graph);
  } else {
    Clique clique = largest_clique(graph, options.max_branches);
    largest = clique.largest;
    vertices = std::move(clique.vertices);
  }
  for (std::uint32_t& vertex : vertices) vertex = chosen[vertex];
  return vertices;
}

}  // namespace

Consistent consistent_pairs(const Matches& matches, const ConsistencyOptions& options) {
  Consistent result;
  const auto selected = selected_pairs(matches, options, result.largest);
  result.selected = static_cast<std::uint32_t>(selected.size());
  if (selected.size() < 3) return result;
  const double max = options.max_correspondence_distance;
  const auto weights = graduated_fit(matches, selected, max, result.T_i_j);
  if (std::ranges::count_if(weights, [](double w) { return w > 0; }) < 3) return result;
  result.inliers = point_pairs::agreeing(matches.q, matches.p, result.T_i_j, max);
  while (result.inliers.size() >= 3) {
    const Pose finer = point_pairs::rigid_fit(matches.q, matches.p, result.inliers);
    auto inliers = point_pairs::agreeing(matches.q, matches.p, finer, max);
    if (inliers.size() < result.inliers.size()) break;
    const bool grew = inliers.size() > result.inliers.size();
    result.T_i_j = finer;
    result.inliers = std::move(inliers);
    if (!grew) break;
  }
  return result;
}

}  // namespace plumb::prune_consistency
