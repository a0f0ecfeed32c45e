#include "cores.hpp"

#include <algorithm>
#include <utility>

namespace plumb::prune_consistency {
namespace {

/// The vertices in order of what is left of their degrees, which fall one by one.
class ByDegree {
 public:
  explicit ByDegree(const point_pairs::BitGraph& graph)
      : degree_(graph.size()), vertex_(graph.size()), place_(graph.size()) {
    for (std::size_t v = 0; v < degree_.size(); ++v) degree_[v] = graph.degree(v);
    begin_.assign(graph.size() + 1, 0);
    for (const std::uint32_t degree : degree_) ++begin_[degree + 1];
    for (std::size_t d = 1; d < begin_.size(); ++d) begin_[d] += begin_[d - 1];
    std::vector<std::uint32_t> next(begin_);
    for (std::uint32_t v = 0; v < degree_.size(); ++v) {
      place_[v] = next[degree_[v]]++;
      vertex_[place_[v]] = v;
    }
  }
  std::uint32_t at(std::size_t place) const { return vertex_[place]; }
  std::uint32_t degree(std::uint32_t v) const { return degree_[v]; }
  /// Moves v to the front of those of its degree, which it leaves.
  void lower(std::uint32_t v) {
    const std::uint32_t front = begin_[degree_[v]]++, other = vertex_[front];
    std::swap(vertex_[front], vertex_[place_[v]]);
    std::swap(place_[other], place_[v]);
    --degree_[v];
  }

 private:
  std::vector<std::uint32_t> degree_, vertex_, place_;
  std::vector<std::uint32_t> begin_;  ///< of each degree: where its vertices begin
};

}  // namespace

std::vector<std::uint32_t> core_numbers(const point_pairs::BitGraph& graph) {
  ByDegree left(graph);
  std::vector<std::uint32_t> core(graph.size());
  for (std::size_t n = 0; n < graph.size(); ++n) {
    const std::uint32_t v = left.at(n);
    core[v] = left.degree(v);
    point_pairs::for_each_bit(graph.row(v), [&](std::uint32_t u) {
      if (left.degree(u) > left.degree(v)) left.lower(u);
    });
  }
  return core;
}

std::vector<std::uint32_t> innermost_core(const point_pairs::BitGraph& graph) {
  const auto core = core_numbers(graph);
  std::vector<std::uint32_t> inner;
  if (core.empty()) return inner;
  const std::uint32_t most = *std::ranges::max_element(core);
  for (std::uint32_t v = 0; v < core.size(); ++v)
    if (core[v] == most) inner.push_back(v);
  return inner;
}

}  // namespace plumb::prune_consistency
