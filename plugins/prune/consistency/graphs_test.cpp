#include <gmock/gmock.h>

#include <algorithm>
#include <bit>

#include "clique.hpp"
#include "cores.hpp"
#include "graphs_testing.hpp"

namespace plumb::prune_consistency {
namespace {

using point_pairs::BitGraph;
using testing::ElementsAre;
using testing::IsEmpty;

/// The definition: of the k-core, for k = 0, 1, ...: vertices with too few neighbours left are
/// taken away until all have enough.
std::vector<std::uint32_t> cores_by_definition(const BitGraph& graph) {
  std::vector<std::uint32_t> core(graph.size(), 0);
  for (std::uint32_t k = 1; k < graph.size(); ++k) {
    std::vector<bool> in(graph.size(), true);
    for (bool changed = true; changed;) {
      changed = false;
      for (std::size_t v = 0; v < graph.size(); ++v) {
        if (!in[v]) continue;
        std::uint32_t neighbours = 0;
        for (std::size_t u = 0; u < graph.size(); ++u) neighbours += in[u] && graph.joined(v, u);
        if (neighbours < k) in[v] = false, changed = true;
      }
    }
    for (std::size_t v = 0; v < graph.size(); ++v)
      if (in[v]) core[v] = k;
  }
  return core;
}

TEST(CoreNumbers, AreThoseOfTheDefinition) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed)
    for (const double share : {0.05, 0.3, 0.8}) {
      const BitGraph graph = random_graph(70, share, seed);
      EXPECT_EQ(core_numbers(graph), cores_by_definition(graph)) << seed << " " << share;
    }
}

TEST(InnermostCore, IsThePlantedOne) {
  BitGraph graph = random_graph(100, 0.05, 3);
  for (std::size_t a = 10; a < 25; ++a)
    for (std::size_t b = a + 1; b < 25; ++b) graph.join(a, b);
  std::vector<std::uint32_t> planted;
  for (std::uint32_t v = 10; v < 25; ++v) planted.push_back(v);
  EXPECT_EQ(innermost_core(graph), planted);
  EXPECT_THAT(innermost_core(BitGraph(0)), IsEmpty());
}

bool is_clique(const BitGraph& graph, const std::vector<std::uint32_t>& vertices) {
  for (const auto a : vertices)
    for (const auto b : vertices)
      if (a != b && !graph.joined(a, b)) return false;
  return true;
}

/// Of all sets of vertices.
std::size_t largest_by_all_sets(const BitGraph& graph) {
  std::size_t most = 0;
  for (std::uint32_t set = 1; set < 1u << graph.size(); ++set) {
    bool all = true;
    for (std::uint32_t left = set; left != 0 && all; left &= left - 1) {
      const auto v = static_cast<std::size_t>(std::countr_zero(left));
      all = (set & ~(std::uint64_t{1} << v) & ~graph.row(v)[0]) == 0;
    }
    if (all) most = std::max<std::size_t>(most, static_cast<std::size_t>(std::popcount(set)));
  }
  return most;
}

TEST(LargestClique, IsAsLargeAsAnySet) {
  for (std::uint64_t seed = 1; seed <= 15; ++seed)
    for (const double share : {0.2, 0.5, 0.8, 1.0}) {
      const BitGraph graph = random_graph(14, share, seed);
      const Clique found = largest_clique(graph, 1000000);
      EXPECT_TRUE(found.largest);
      EXPECT_TRUE(is_clique(graph, found.vertices));
      EXPECT_TRUE(std::ranges::is_sorted(found.vertices));
      EXPECT_EQ(found.vertices.size(), largest_by_all_sets(graph)) << seed << " " << share;
    }
}

TEST(LargestClique, IsThePlantedOne) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    BitGraph graph = random_graph(400, 0.2, seed);
    std::vector<std::uint32_t> planted;
    for (std::uint32_t k = 0; k < 25; ++k) planted.push_back(16 * k + 3);
    for (const auto a : planted)
      for (const auto b : planted)
        if (a != b) graph.join(a, b);
    const Clique found = largest_clique(graph, 1000000);
    EXPECT_TRUE(found.largest) << seed;
    EXPECT_EQ(found.vertices, planted) << seed;
  }
}

TEST(LargestClique, SaysWhereTheSearchEndedEarly) {
  const BitGraph graph = random_graph(200, 0.9, 1);
  const Clique found = largest_clique(graph, 1);
  EXPECT_FALSE(found.largest);
  EXPECT_TRUE(is_clique(graph, found.vertices));
  EXPECT_GT(found.vertices.size(), 15u) << "what grows greedily";
}

TEST(LargestClique, OfNoAndOfLoneVertices) {
  EXPECT_THAT(largest_clique(BitGraph(0), 10).vertices, IsEmpty());
  EXPECT_EQ(largest_clique(BitGraph(3), 10).vertices.size(), 1u);
  BitGraph pair(3);
  pair.join(0, 2);
  EXPECT_THAT(largest_clique(pair, 10).vertices, ElementsAre(0, 2));
}

}  // namespace
}  // namespace plumb::prune_consistency
