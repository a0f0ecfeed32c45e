#include "join.hpp"

#include <algorithm>

#include "plumb/data/error.hpp"

namespace plumb::edges_union {

Edges joined(const std::vector<const Edges*>& lists) {
  Edges all;
  if (lists.empty()) return all;
  all.segments = lists.front()->segments;
  for (const Edges* edges : lists) {
    if (edges->segments != all.segments)
      throw Error("edges of " + std::to_string(all.segments) + " and of " +
                  std::to_string(edges->segments) +
                  " segments cannot be joined: wire edges of the same segments");
    all.list.insert(all.list.end(), edges->list.begin(), edges->list.end());
  }
  const auto pair = [](const Edge& e) { return std::pair(e.i, e.j); };
  std::ranges::stable_sort(all.list, {}, pair);
  const auto rest = std::ranges::unique(all.list, {}, pair);
  all.list.erase(rest.begin(), rest.end());
  return all;
}

}  // namespace plumb::edges_union
