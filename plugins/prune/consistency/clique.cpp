#include "clique.hpp"

#include <algorithm>
#include <bit>
#include <functional>
#include <numeric>
#include <span>

#include "cores.hpp"

namespace plumb::prune_consistency {
namespace {

using point_pairs::BitGraph;
using Bits = std::vector<std::uint64_t>;
using Vertices = std::vector<std::uint32_t>;

bool any(const Bits& bits) {
  return std::ranges::any_of(bits, [](std::uint64_t word) { return word != 0; });
}
void clear(Bits& bits, std::size_t k) { bits[k / 64] &= ~(std::uint64_t{1} << (k % 64)); }
std::size_t first_of(const Bits& bits) {
  std::size_t w = 0;
  while (bits[w] == 0) ++w;
  return w * 64 + static_cast<std::size_t>(std::countr_zero(bits[w]));
}
void intersect(Bits& bits, std::span<const std::uint64_t> row) {
  for (std::size_t w = 0; w < bits.size(); ++w) bits[w] &= row[w];
}

/// The given vertices and what joins them, in that order.
BitGraph part_of(const BitGraph& graph, const Vertices& vertices) {
  BitGraph part(vertices.size());
  for (std::size_t a = 0; a < vertices.size(); ++a)
    for (std::size_t b = a + 1; b < vertices.size(); ++b)
      if (graph.joined(vertices[a], vertices[b])) part.join(a, b);
  return part;
}

/// From each vertex the first candidate is taken until none is left.
Vertices greedy_clique(const BitGraph& graph) {
  Vertices best;
  for (std::uint32_t v = 0; v < graph.size(); ++v) {
    if (graph.degree(v) < best.size()) continue;
    Vertices clique{v};
    Bits candidates(graph.row(v).begin(), graph.row(v).end());
    while (any(candidates)) {
      const std::size_t next = first_of(candidates);
      clique.push_back(static_cast<std::uint32_t>(next));
      intersect(candidates, graph.row(next));
    }
    if (clique.size() > best.size()) best = std::move(clique);
  }
  return best;
}

/// Branch and bound.
class Search {
 public:
  Search(const BitGraph& graph, std::size_t to_beat, std::uint64_t max_branches)
      : graph_(graph), to_beat_(to_beat), branches_left_(max_branches) {}

  /// Larger than `to_beat`, or empty.
  Vertices run() {
    Bits all(graph_.words(), 0);
    for (std::size_t v = 0; v < graph_.size(); ++v) all[v / 64] |= std::uint64_t{1} << (v % 64);
    expand(std::move(all));
    return std::move(best_);
  }
  bool ended() const { return ended_; }

 private:
  struct Coloured {
    std::uint32_t vertex, colour;  ///< colours from 1 on; those of one colour are not joined
  };

  std::vector<Coloured> coloured(Bits uncoloured) const {
    std::vector<Coloured> result;
    for (std::uint32_t colour = 1; any(uncoloured); ++colour) {
      Bits apart = uncoloured;
      while (any(apart)) {
        const std::size_t v = first_of(apart);
        result.push_back({static_cast<std::uint32_t>(v), colour});
        clear(apart, v);
        clear(uncoloured, v);
        for (std::size_t w = 0; w < apart.size(); ++w) apart[w] &= ~graph_.row(v)[w];
      }
    }
    return result;
  }

  /// A clique among the candidates has no more vertices than they have colours.
  void expand(Bits candidates) {
    if (branches_left_ == 0) {
      ended_ = false;
      return;
    }
    --branches_left_;
    const auto order = coloured(candidates);
    for (std::size_t k = order.size(); k-- > 0 && ended_;) {
      if (current_.size() + order[k].colour <= to_beat_) return;
      const std::uint32_t v = order[k].vertex;
      current_.push_back(v);
      Bits next = candidates;
      intersect(next, graph_.row(v));
      if (any(next)) {
        expand(std::move(next));
      } else if (current_.size() > to_beat_) {
        best_ = current_;
        to_beat_ = best_.size();
      }
      current_.pop_back();
      clear(candidates, v);
    }
  }

  const BitGraph& graph_;
  std::size_t to_beat_;
  std::uint64_t branches_left_;
  bool ended_ = true;
  Vertices current_, best_;
};

}  // namespace

Clique largest_clique(const BitGraph& graph, std::uint64_t max_branches) {
  const auto core = core_numbers(graph);
  Vertices order(graph.size());  // inner ones first
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, std::ranges::greater(), [&](std::uint32_t v) { return core[v]; });

  Clique result;
  const auto named = [](const Vertices& places, const Vertices& names) {
    Vertices vertices;
    for (const std::uint32_t place : places) vertices.push_back(names[place]);
    std::ranges::sort(vertices);
    return vertices;
  };
  result.vertices = named(greedy_clique(part_of(graph, order)), order);
  const std::size_t to_beat = result.vertices.size();
  std::erase_if(order, [&](std::uint32_t v) { return core[v] < to_beat; });
  if (order.size() <= to_beat) return result;
  const BitGraph left = part_of(graph, order);
  Search search(left, to_beat, max_branches);
  if (const Vertices larger = search.run(); !larger.empty()) result.vertices = named(larger, order);
  result.largest = search.ended();
  return result;
}

}  // namespace plumb::prune_consistency
