#include "sequential.hpp"

namespace plumb::edges_sequential {

Edges sequential_edges(const std::vector<Eigen::Vector3d>& positions) {
  Edges edges;
  edges.segments = static_cast<std::uint32_t>(positions.size());
  for (std::uint32_t k = 0; k + 1 < edges.segments; ++k) {
    const auto distance = static_cast<float>((positions[k + 1] - positions[k]).norm());
    edges.list.push_back({k, k + 1, EdgeKind::sequential, 1.0f, distance});
  }
  return edges;
}

}  // namespace plumb::edges_sequential
