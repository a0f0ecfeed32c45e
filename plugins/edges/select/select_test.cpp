#include "select.hpp"

#include <gmock/gmock.h>

#include <map>
#include <set>

#include "plumb/data/io/file_testing.hpp"
#include "plumb/plugin/step_testing.hpp"
#include "plumb/slam/step.hpp"

namespace plumb::edges_select {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using Pair = std::pair<std::uint32_t, std::uint32_t>;

std::vector<Eigen::Vector3d> in_a_line(std::size_t n) {
  std::vector<Eigen::Vector3d> positions;
  for (std::size_t k = 0; k < n; ++k) positions.emplace_back(10.0 * static_cast<double>(k), 0, 0);
  return positions;
}
Edge edge(std::uint32_t i, std::uint32_t j, double score) {
  return {i, j, j == i + 1 ? EdgeKind::sequential : EdgeKind::neighbour, static_cast<float>(score),
          0};
}
std::vector<Pair> pairs_of(const Edges& edges) {
  std::vector<Pair> pairs;
  for (const Edge& e : edges.list) pairs.emplace_back(e.i, e.j);
  return pairs;
}
/// Every pair of segments no farther apart than `reach` in the list.
Edges all_within(std::uint32_t segments, std::uint32_t reach) {
  Edges edges{segments, {}};
  for (std::uint32_t i = 0; i < segments; ++i)
    for (std::uint32_t j = i + 1; j <= std::min(segments - 1, i + reach); ++j)
      edges.list.push_back(edge(i, j, 0.5));
  return edges;
}
/// A share of all pairs, with scores that all differ.
Edges random_edges(std::uint32_t segments, double share, std::uint64_t seed) {
  Random random(seed);
  Edges edges{segments, {}};
  for (std::uint32_t i = 0; i < segments; ++i)
    for (std::uint32_t j = i + 1; j < segments; ++j)
      if (j == i + 1 || random.uniform() < share)
        edges.list.push_back(edge(i, j, random.uniform()));
  return edges;
}
Poses poses_at(const std::vector<Eigen::Vector3d>& positions) {
  Poses poses;
  for (const auto& position : positions)
    poses.T_world_segment.push_back({Eigen::Quaterniond::Identity(), position});
  return poses;
}

/// The rule of the header once more, by sets: which edges segment s asks for.
std::set<Pair> asked_by(std::uint32_t s, const Edges& edges, const SelectOptions& options) {
  std::map<std::uint32_t, float> score;
  for (const Edge& e : edges.list) {
    if (e.i == s) score[e.j] = e.score;
    if (e.j == s) score[e.i] = e.score;
  }
  std::vector<std::set<std::uint32_t>> runs;
  const auto is_partner = [&](std::uint32_t k) { return k == s || score.contains(k); };
  for (std::uint32_t k = 0; k < edges.segments; ++k) {
    if (!is_partner(k)) continue;
    if (runs.empty() || k - *runs.back().rbegin() > 2) runs.emplace_back();
    runs.back().insert(k);
  }
  std::set<Pair> asked;
  const auto ask = [&](std::uint32_t k) { asked.insert({std::min(s, k), std::max(s, k)}); };
  std::vector<std::vector<std::pair<float, std::uint32_t>>> visits;
  for (const auto& run : runs) {
    if (run.contains(s)) {
      for (const int side : {-1, 1}) {
        // Each interval from one of Fibonacci's numbers to the next gives its nearest partner.
        const int fibonacci[] = {2, 3, 5, 8, 13, 21, 34, 55, 89};
        std::uint32_t taken = 0;
        for (int f = 0; f < 8 && taken < options.max_along; ++f)
          for (int away = fibonacci[f]; away < fibonacci[f + 1]; ++away) {
            const int k = static_cast<int>(s) + side * away;
            if (k < 0 || !run.contains(static_cast<std::uint32_t>(k))) continue;
            ask(static_cast<std::uint32_t>(k)), ++taken;
            break;
          }
      }
    } else {
      visits.emplace_back();
      for (const auto k : run) visits.back().push_back({-score[k], k});
      std::ranges::sort(visits.back());
    }
  }
  std::ranges::sort(visits);
  for (std::size_t v = 0; v < visits.size() && v < options.max_visits; ++v)
    for (std::size_t k = 0; k < visits[v].size() && k < options.per_visit; ++k)
      ask(visits[v][k].second);
  return asked;
}

TEST(SelectEdges, KeepsThoseToFibonaccisNumbersAlongAPath) {
  const auto selected = select_edges(all_within(60, 20), in_a_line(60), {});
  std::vector<Pair> expected;
  for (std::uint32_t i = 0; i < 60; ++i)
    for (const std::uint32_t away : {1, 2, 3, 5, 8})
      if (i + away < 60) expected.emplace_back(i, i + away);
  EXPECT_EQ(pairs_of(selected), expected);
  EXPECT_EQ(selected.segments, 60u);
}

TEST(SelectEdges, TakesTheNextPartnerBeyondWhereOneIsMissing) {
  Edges edges{
      10,
      {edge(0, 1, 1), edge(0, 3, 1), edge(0, 4, 1), edge(0, 6, 1), edge(0, 8, 1), edge(0, 9, 1)}};
  SelectOptions options;
  options.max_visits = 0;
  EXPECT_THAT(pairs_of(select_edges(edges, in_a_line(10), options)),
              ElementsAre(Pair(0, 1), Pair(0, 3), Pair(0, 6), Pair(0, 8)));
  options.max_along = 1;
  EXPECT_THAT(pairs_of(select_edges(edges, in_a_line(10), options)),
              ElementsAre(Pair(0, 1), Pair(0, 3)));
}

TEST(SelectEdges, KeepsTheBestPartnerOfAnotherVisit) {
  Edges edges{14, {}};  // two visits of four segments, each joined with each
  for (std::uint32_t i = 0; i < 4; ++i)
    for (std::uint32_t j = 10; j < 14; ++j)
      edges.list.push_back(edge(i, j, i + 10 == j ? 0.9 : 0.3));
  SelectOptions options;
  options.per_visit = 1;
  EXPECT_THAT(pairs_of(select_edges(edges, in_a_line(14), options)),
              ElementsAre(Pair(0, 10), Pair(1, 11), Pair(2, 12), Pair(3, 13)));
}

TEST(SelectEdges, AsksTheVisitsWithTheGreatestScoresFirst) {
  const Edges edges{21, {edge(0, 10, 0.9), edge(0, 20, 0.5), edge(10, 20, 0.8)}};
  SelectOptions options;
  options.max_visits = 1;
  EXPECT_THAT(pairs_of(select_edges(edges, in_a_line(21), options)),
              ElementsAre(Pair(0, 10), Pair(10, 20)));
  options.max_visits = 2;
  EXPECT_EQ(select_edges(edges, in_a_line(21), options).size(), 3u);
}

TEST(SelectEdges, CountsAVisitAsOneWhereOneOfItsSegmentsIsMissing) {
  SelectOptions options;
  options.max_visits = 1;  // the partners of 0 have better ones than 0, so they do not ask for it
  const Edges one_missing{
      41, {edge(0, 10, 0.9), edge(0, 12, 0.8), edge(10, 30, 0.95), edge(12, 40, 0.95)}};
  EXPECT_EQ(select_edges(one_missing, in_a_line(41), options).size(), 4u);
  const Edges two_missing{
      41, {edge(0, 10, 0.9), edge(0, 13, 0.8), edge(10, 30, 0.95), edge(13, 40, 0.95)}};
  EXPECT_THAT(pairs_of(select_edges(two_missing, in_a_line(41), options)),
              ElementsAre(Pair(0, 10), Pair(10, 30), Pair(13, 40)));
}

TEST(SelectEdges, DropsWhatTooMuchPathLiesBetweenButNothingSequential) {
  std::vector<Eigen::Vector3d>
      there_and_back;  // 0 and 4 are at one place with 40 m of path between them
  for (const double x : {0, 10, 20, 10, 0}) there_and_back.emplace_back(x, 0, 0);
  const Edges edges{
      5,
      {edge(0, 1, 1), edge(0, 2, 1), edge(0, 4, 1), edge(1, 2, 1), edge(2, 3, 1), edge(3, 4, 1)}};
  SelectOptions options;
  options.max_path_separation = 20;
  EXPECT_THAT(pairs_of(select_edges(edges, there_and_back, options)),
              ElementsAre(Pair(0, 1), Pair(0, 2), Pair(1, 2), Pair(2, 3), Pair(3, 4)));
  options.max_path_separation = 5;
  EXPECT_THAT(pairs_of(select_edges(edges, there_and_back, options)),
              ElementsAre(Pair(0, 1), Pair(1, 2), Pair(2, 3), Pair(3, 4)));
}

TEST(SelectEdges, AreThoseThatASecondWayToAskFinds) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Edges edges = random_edges(50, 0.05 * static_cast<double>(seed), seed);
    SelectOptions options;
    options.max_along = static_cast<std::uint32_t>(seed % 5);
    options.max_visits = static_cast<std::uint32_t>(seed % 4);
    options.per_visit = 1 + static_cast<std::uint32_t>(seed % 3);
    std::set<Pair> expected;
    for (const Edge& e : edges.list)
      if (e.kind == EdgeKind::sequential) expected.insert({e.i, e.j});
    for (std::uint32_t s = 0; s < edges.segments; ++s) expected.merge(asked_by(s, edges, options));
    const auto pairs = pairs_of(select_edges(edges, in_a_line(50), options));
    EXPECT_EQ(pairs, std::vector<Pair>(expected.begin(), expected.end())) << "seed " << seed;
  }
}

TEST(SelectEdges, GrowInNumberWithTheSegmentsAlone) {
  const SelectOptions options;
  const std::uint32_t most = 1 + 2 * options.max_along + options.max_visits * options.per_visit;
  for (const std::uint32_t n : {50u, 100u, 200u})
    EXPECT_LE(select_edges(random_edges(n, 0.7, n), in_a_line(n), options).size(), most * n);
}

TEST(SelectEdges, AreNoneOfNoneAndOfNoSegments) {
  EXPECT_EQ(select_edges({}, {}, {}).size(), 0u);
  EXPECT_EQ(select_edges({5, {}}, in_a_line(5), {}).segments, 5u);
}

TEST(SelectEdgesStep, KeepsWhatTheKernelKeepsAndCountsTheRest) {
  const Edges edges = all_within(30, 10);
  TestContext context;
  const auto selected = StepUnderTest(*plumb_module())
                            .with("edges", edges)
                            .with("poses", poses_at(in_a_line(30)))
                            .set("max_along", std::int64_t(1))
                            .run<Edges>("edges", context);
  EXPECT_EQ(selected.size(), 29u + 28u);
  EXPECT_EQ(context.counts["edges left out"], edges.size() - selected.size());
}

TEST(SelectEdgesStep, RefusesPosesOfOtherSegments) {
  TestContext context;
  StepUnderTest step(*plumb_module());
  step.with("edges", all_within(30, 10)).with("poses", poses_at(in_a_line(29)));
  EXPECT_THAT(io::refusal([&] { step.run<Edges>("edges", context); }),
              testing::AllOf(HasSubstr("30 segments"), HasSubstr("29 poses")));
}

TEST(SelectEdgesStep, MultipliesThePathByAScaleAndLeavesNoneAlone) {
  const auto kept = [](std::optional<double> path, double scale) {
    TestContext context;
    StepUnderTest step(*plumb_module());
    step.with("edges", all_within(30, 10)).with("poses", poses_at(in_a_line(30)));
    if (path) step.set("max_path_separation", *path);
    if (scale != 1) step.with("scale", Metrics().add("scale", scale, ""));
    return pairs_of(step.run<Edges>("edges", context));
  };
  EXPECT_EQ(kept(60, 0.5), kept(30, 1));
  EXPECT_EQ(kept(15, 2), kept(30, 1));
  EXPECT_NE(kept(60, 1), kept(30, 1));
  EXPECT_EQ(kept({}, 0.5), kept({}, 1));
}

}  // namespace
}  // namespace plumb::edges_select
