#include "inner.hpp"

#include "plumb/data/error.hpp"

namespace plumb::prune_edge_points {

std::vector<std::uint32_t> inner(const Matches& matches) {
  if (matches.at_border.size() != matches.size())
    throw Error(
        "the pairs do not say which points lie at a border: take them from a step that "
        "does, such as match.fpfh_mutual");
  std::vector<std::uint32_t> kept;
  for (std::uint32_t k = 0; k < matches.size(); ++k)
    if (!matches.at_border[k]) kept.push_back(k);
  return kept;
}

}  // namespace plumb::prune_edge_points
