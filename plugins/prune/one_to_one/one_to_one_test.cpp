#include "one_to_one.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <numeric>
#include <set>

#include "plumb/data/random.hpp"
#include "plumb/plugin/step_testing.hpp"
#include "plumb/slam/step.hpp"

namespace plumb::prune_one_to_one {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

/// Pairs along x with these indices and distances under the identity.
Matches pairs(std::vector<std::uint32_t> index_p, std::vector<std::uint32_t> index_q,
              const std::vector<float>& distances) {
  Matches matches;
  for (const float distance : distances) {
    matches.p.push_back({distance, 3, 0});
    matches.q.push_back({0, 3, 0});
    matches.weight.push_back(1);
  }
  matches.index_p = std::move(index_p), matches.index_q = std::move(index_q);
  matches.found = static_cast<std::uint32_t>(distances.size());
  return matches;
}

TEST(OneToOne, KeepsTheClosestOfThePairsWithOnePoint) {
  // Points 5 and 6 of j are each wanted by several of i; then point 1 of i has two left.
  const Matches matches = pairs({0, 1, 2, 1, 3, 4}, {5, 5, 5, 6, 6, 7}, {3, 1, 2, 0.5f, 4, 9});
  EXPECT_THAT(one_to_one(matches, Pose()), ElementsAre(3, 5));
}

TEST(OneToOne, MeasuresUnderThePoses) {
  const Matches matches = pairs({0, 1}, {7, 7}, {0, 2});
  EXPECT_THAT(one_to_one(matches, Pose()), ElementsAre(0));
  EXPECT_THAT(one_to_one(matches, Pose(Eigen::Quaterniond::Identity(), {2, 0, 0})), ElementsAre(1));
}

TEST(OneToOne, LeavesPairsThatShareNothingAsTheyAre) {
  const Matches matches = pairs({4, 3, 2}, {2, 3, 4}, {1, 1, 1});
  EXPECT_THAT(one_to_one(matches, Pose()), ElementsAre(0, 1, 2));
  EXPECT_THAT(one_to_one(Matches(), Pose()), IsEmpty());
}

/// Of the pairs in `among` with the same point the closest, one after the other.
std::vector<std::uint32_t> plainly(const std::vector<std::uint32_t>& among,
                                   const std::vector<std::uint32_t>& point,
                                   const std::vector<float>& distances) {
  std::vector<std::uint32_t> kept;
  for (const auto a : among)
    if (std::ranges::all_of(among, [&](std::uint32_t b) {
          return point[a] != point[b] || distances[a] <= distances[b];
        }))
      kept.push_back(a);
  return kept;
}

TEST(OneToOne, IsWhatComparingAllPairsGives) {
  Random random(2);
  std::vector<std::uint32_t> index_p, index_q, all(500);
  std::vector<float> distances;
  for (int k = 0; k < 500; ++k) {
    index_p.push_back(random.below(150)), index_q.push_back(random.below(150));
    distances.push_back(static_cast<float>(random.uniform()));
  }
  std::iota(all.begin(), all.end(), 0);
  const auto kept = one_to_one(pairs(index_p, index_q, distances), Pose());
  EXPECT_EQ(kept, plainly(plainly(all, index_q, distances), index_p, distances));
  std::set<std::uint32_t> of_i, of_j;
  for (const auto k : kept) of_i.insert(index_p[k]), of_j.insert(index_q[k]);
  EXPECT_EQ(of_i.size(), kept.size());
  EXPECT_EQ(of_j.size(), kept.size());
}

TEST(OneToOneStep, CountsWhatItDropsAndRefusesPairsWithoutIndices) {
  TestContext context;
  StepUnderTest step(*plumb_module());
  step.with("matches", pairs({0, 1}, {7, 7}, {0, 2})).part("poses", Pose());
  const auto kept = step.run<Matches>("matches", context);
  EXPECT_THAT(kept.index_p, ElementsAre(0));
  EXPECT_EQ(kept.found, 2u);
  EXPECT_EQ(context.counts["pairs dropped"], 1u);
  step.with("matches", pairs({}, {}, {0, 2}));
  EXPECT_THROW(step.run<Matches>("matches", context), Error);
}

}  // namespace
}  // namespace plumb::prune_one_to_one
