#pragma once
/// Connected parts of a graph.

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <string>
#include <vector>

namespace plumb::solve_pose_graph {

/// Union-find over vertices 0 .. n-1; a part is known by its smallest vertex.
class Parts {
 public:
  explicit Parts(std::size_t vertices) : parent_(vertices) {
    std::iota(parent_.begin(), parent_.end(), 0u);
  }
  void join(std::uint32_t a, std::uint32_t b) {
    a = first_of(a), b = first_of(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }
  /// The smallest vertex of v's part.
  std::uint32_t first_of(std::uint32_t v) const {
    while (parent_[v] != v) v = parent_[v];
    return v;
  }
  /// The parts' vertices, each in order, parts in order of their first vertex.
  std::vector<std::vector<std::uint32_t>> list() const {
    std::vector<std::vector<std::uint32_t>> by_first(parent_.size()), parts;
    for (std::uint32_t v = 0; v < parent_.size(); ++v) by_first[first_of(v)].push_back(v);
    for (auto& part : by_first)
      if (!part.empty()) parts.push_back(std::move(part));
    return parts;
  }

 private:
  std::vector<std::uint32_t> parent_;
};

/// Vertices in order as people write them: "0-4, 7, 9-11"; after six runs "and N more".
inline std::string runs_of(const std::vector<std::uint32_t>& vertices) {
  std::string text;
  int runs = 0;
  for (std::size_t k = 0; k < vertices.size();) {
    if (++runs > 6) return text + " and " + std::to_string(vertices.size() - k) + " more";
    std::size_t end = k + 1;
    while (end < vertices.size() && vertices[end] == vertices[end - 1] + 1) ++end;
    if (!text.empty()) text += ", ";
    text += std::to_string(vertices[k]);
    if (end - k > 1) text += "-" + std::to_string(vertices[end - 1]);
    k = end;
  }
  return text;
}

}  // namespace plumb::solve_pose_graph
