#include "inner.hpp"

#include "plumb/data/error.hpp"
#include "plumb/slam/geometry/search_tree.hpp"

namespace plumb::prune_edge_points {
namespace {

SearchTree edge_points(const Features& features) {
  if (features.at_border.size() != features.size())
    throw Error(
        "the features do not say which of their points lie at a border: take them from a step that "
        "does, such as describe.fpfh");
  Cloud edge;
  for (std::size_t k = 0; k < features.size(); ++k)
    if (features.at_border[k]) edge.add(features.points[k]);
  return SearchTree(edge);
}

}  // namespace

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

std::vector<std::uint32_t> inner(const Matches& matches, const Features& of_i, const Features& of_j,
                                 double distance) {
  const SearchTree edge_i = edge_points(of_i), edge_j = edge_points(of_j);
  const auto near = [&](const SearchTree& edge, const Eigen::Vector3f& point) {
    SearchTree::Neighbour found;
    return edge.nearest_within(point, static_cast<float>(distance), found);
  };
  std::vector<std::uint32_t> kept;
  for (std::uint32_t k = 0; k < matches.size(); ++k)
    if (!near(edge_i, matches.p[k]) && !near(edge_j, matches.q[k])) kept.push_back(k);
  return kept;
}

}  // namespace plumb::prune_edge_points
