#include "hough.hpp"

#include <gmock/gmock.h>

#include <algorithm>

#include "plumb/plugin/step_testing.hpp"
#include "plumb/slam/step.hpp"
#include "shared/pcl/pairs_testing.hpp"
#include "shared/pcl/street_testing.hpp"

namespace plumb::prune_hough {
namespace {

using pcl::planted;
using pcl::right_of;
using pcl::segment_of;
using testing::ElementsAre;
using testing::IsEmpty;

/// What drift leaves between the present poses and the true ones: 1.2 m and 1 degree.
const Pose drift(exp_rotation({0, 0, 0.017}), {1.0, -0.6, 0.2});

TEST(Hough, FindsTheRightPairsUnderADriftedPose) {
  for (const std::uint64_t seed : {1, 2, 3, 4, 5}) {
    const Matches matches = planted(80, 120, drift, 5, seed);
    const auto kept = most_voted(matches, frames_of_pose(200, Pose()), {});
    EXPECT_GE(right_of(kept, 80), 64u) << seed;
    EXPECT_LE(kept.size() - right_of(kept, 80), kept.size() / 10) << seed;
    EXPECT_TRUE(std::ranges::is_sorted(kept));
  }
}

TEST(Hough, VotesWhereTheFramesPutTheOtherSegment) {
  // Both axes of each pair are right although no pose is: every right pair votes for one place.
  const Pose far_off(exp_rotation({0.2, -0.4, 2.6}), {40, -3, 2});
  const Matches matches = planted(40, 160, far_off, 20, 6);
  EXPECT_GE(right_of(most_voted(matches, frames_of_pose(200, far_off), {}), 40), 34u);
  EXPECT_LT(right_of(most_voted(matches, frames_of_pose(200, Pose()), {}), 40), 20u);
}

/// Pairs of points of a street corner and of the same corner elsewhere; the first `right` are
/// right.
Matches of_corner(const Cloud& i, const Cloud& j, std::uint32_t right, std::uint32_t wrong) {
  Random random(7);
  Matches matches;
  for (std::uint32_t k = 0; k < right + wrong; ++k) {
    const auto at = random.below(static_cast<std::uint32_t>(i.size())),
               other = random.below(static_cast<std::uint32_t>(i.size()));
    matches.p.push_back(i.point(at));
    matches.q.push_back(j.point(k < right ? at : other));
    matches.index_p.push_back(k);
    matches.weight.push_back(1);
  }
  matches.found = right + wrong;
  return matches;
}

TEST(Hough, WithLocalFramesNeedsNoPose) {
  const Cloud i = pcl::street_corner(4000, 8);
  const Cloud j = pcl::moved(i, Pose(exp_rotation({0.1, 0.3, -2}), {30, 5, -1}));
  const Matches matches = of_corner(i, j, 60, 100);
  const auto kept = most_voted(matches, local_frames(matches, i, j, 1.5), {});
  EXPECT_GE(right_of(kept, 60), 50u);
  EXPECT_LE(kept.size() - right_of(kept, 60), 6u);
}

TEST(Hough, PairsWithoutAFrameDoNotVote) {
  const Matches matches = planted(30, 0, Pose(), 1, 9);
  PairFrames frames = frames_of_pose(30, Pose());
  const Cloud nothing;
  EXPECT_THAT(most_voted(matches, local_frames(matches, nothing, nothing, 1), {}), IsEmpty());
  frames.at_p[3] = local_frames(matches, nothing, nothing, 1).at_p[0];
  const auto kept = most_voted(matches, frames, {});
  EXPECT_GE(kept.size(), 25u);
  EXPECT_FALSE(std::ranges::binary_search(kept, 3u));
}

TEST(Hough, VotesInThePlaneToo) {
  Matches matches = planted(40, 60, Pose(Eigen::Quaterniond::Identity(), {0.7, 0.2, 0}), 4, 10);
  for (auto* points : {&matches.p, &matches.q})
    for (auto& point : *points) point.z() = 0;
  const auto kept = most_voted(matches, frames_of_pose(100, Pose()), {});
  EXPECT_GE(right_of(kept, 40), 34u);
}

TEST(Hough, RefusesVotesThatNoGridHolds) {
  const Matches matches = planted(0, 20, Pose(), 1000, 11);
  EXPECT_THROW(most_voted(matches, frames_of_pose(20, Pose()), {.hough_bin_size = 0.5}), Error);
}

Matches run(StepUnderTest& step, const Matches& matches, TestContext& context) {
  return step.with("matches", matches).part("poses", Pose()).run<Matches>("matches", context);
}

TEST(HoughStep, HasThePortsOfKMeans) {
  TestContext context;
  StepUnderTest step(*plumb_module());
  const Matches kept = run(step, planted(80, 120, drift, 5, 12), context);
  EXPECT_GE(right_of(kept.index_p, 80), 64u);
  EXPECT_EQ(kept.found, 200u);
  EXPECT_EQ(context.counts["pairs dropped"], 200 - kept.size());
  EXPECT_THAT(run(step, planted(2, 3, drift, 5, 13), context).index_p, ElementsAre(0, 1, 2, 3, 4));
  EXPECT_EQ(context.counts["edges with too few pairs to group, kept whole"], 1u);
  EXPECT_EQ(run(step, planted(0, 10, Pose(), 40, 14), context).size(), 0u);
  EXPECT_EQ(context.counts["edges whose pairs vote for no place"], 1u);
}

TEST(HoughStep, TakesLocalFramesFromTheSegments) {
  const Cloud i = pcl::street_corner(4000, 15);
  const Cloud j = pcl::moved(i, Pose(exp_rotation({0, 0, 2}), {-10, 5, 0}));
  const Matches matches = of_corner(i, j, 60, 60);
  TestContext context;
  StepUnderTest step(*plumb_module());
  step.set("frames", std::string("local")).set("lrf_radius", 1.5);
  EXPECT_THROW(run(step, matches, context), Error);
  step.ends("segments", segment_of(i), segment_of(j));
  EXPECT_GE(right_of(run(step, matches, context).index_p, 60), 50u);
}

}  // namespace
}  // namespace plumb::prune_hough
