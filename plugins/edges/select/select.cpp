#include "select.hpp"

#include <algorithm>

namespace plumb::edges_select {
namespace {

struct Partner {
  std::uint32_t segment;
  std::uint32_t edge;  ///< its place in the list of edges
  float score;
};

std::vector<double> path_to(const std::vector<Eigen::Vector3d>& positions) {
  std::vector<double> path(positions.size(), 0);
  for (std::size_t k = 1; k < positions.size(); ++k)
    path[k] = path[k - 1] + (positions[k] - positions[k - 1]).norm();
  return path;
}

/// Partners on one side of a segment, nearest first: takes those next to 2, 3, 5, 8 ... away.
template <class Take>
void take_along(std::uint32_t segment, const std::vector<Partner>& nearest_first,
                std::uint32_t most, const Take& take) {
  std::uint32_t want = 2, before = 1, taken = 0;
  for (const Partner& partner : nearest_first) {
    const std::uint32_t away =
        partner.segment > segment ? partner.segment - segment : segment - partner.segment;
    if (taken == most) return;
    if (away < want) continue;
    take(partner);
    ++taken;
    while (want <= away) {
      const std::uint32_t next = want + before;
      before = want;
      want = next;
    }
  }
}

}  // namespace

Edges select_edges(const Edges& edges, const std::vector<Eigen::Vector3d>& positions,
                   const SelectOptions& options) {
  const auto path = path_to(positions);
  std::vector<std::vector<Partner>> partners(edges.segments);
  std::vector<bool> kept(edges.size(), false);
  for (std::uint32_t k = 0; k < edges.size(); ++k) {
    const Edge& e = edges.list[k];
    if (e.kind == EdgeKind::sequential) kept[k] = true;
    if (options.max_path_separation &&
        std::abs(path[e.j] - path[e.i]) > *options.max_path_separation)
      continue;
    partners[e.i].push_back({e.j, k, e.score});
    partners[e.j].push_back({e.i, k, e.score});
  }
  const auto take = [&](const Partner& partner) { kept[partner.edge] = true; };
  for (std::uint32_t s = 0; s < edges.segments; ++s) {
    auto& all = partners[s];
    all.push_back({s, 0, 0});  // itself, so that its own visit is one run
    std::ranges::sort(all, {}, &Partner::segment);
    std::vector<std::vector<Partner>> others;
    for (std::size_t first = 0; first < all.size();) {
      std::size_t end = first + 1;
      while (end < all.size() && all[end].segment <= all[end - 1].segment + 2)
        ++end;  // one may be missing
      std::vector<Partner> run(all.begin() + static_cast<std::ptrdiff_t>(first),
                               all.begin() + static_cast<std::ptrdiff_t>(end));
      first = end;
      const auto self = std::ranges::find(run, s, &Partner::segment);
      if (self == run.end()) {
        std::ranges::stable_sort(run, std::ranges::greater(), &Partner::score);
        others.push_back(std::move(run));
        continue;
      }
      const std::vector<Partner> before(std::make_reverse_iterator(self), run.rend()),
          after(self + 1, run.end());
      take_along(s, before, options.max_along, take);
      take_along(s, after, options.max_along, take);
    }
    std::ranges::stable_sort(others, std::ranges::greater(),
                             [](const auto& run) { return run.front().score; });
    for (std::size_t v = 0; v < std::min<std::size_t>(others.size(), options.max_visits); ++v)
      for (std::size_t k = 0; k < std::min<std::size_t>(others[v].size(), options.per_visit); ++k)
        take(others[v][k]);
  }
  Edges selected;
  selected.segments = edges.segments;
  for (std::size_t k = 0; k < edges.size(); ++k)
    if (kept[k]) selected.list.push_back(edges.list[k]);
  return selected;
}

}  // namespace plumb::edges_select
