#include "nearest.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <numbers>

#include "plumb/data/io/file_testing.hpp"
#include "plumb/plugin/step_testing.hpp"
#include "plumb/slam/cloud_testing.hpp"
#include "plumb/slam/step.hpp"

namespace plumb::match_nearest {
namespace {

Cloud random_cloud(std::size_t count, float half, std::uint64_t seed) {
  Random random(seed);
  Cloud cloud;
  for (std::size_t k = 0; k < count; ++k)
    cloud.add({half * static_cast<float>(2 * random.uniform() - 1),
               half * static_cast<float>(2 * random.uniform() - 1),
               half * static_cast<float>(random.uniform())});
  return cloud;
}
void give_normals(Cloud& cloud, const Eigen::Vector3f& n) {
  cloud.nx.assign(cloud.size(), n.x());
  cloud.ny.assign(cloud.size(), n.y());
  cloud.nz.assign(cloud.size(), n.z());
}

const Pose T_i_j(exp_rotation({0.02, -0.01, 0.4}), {6, -2, 0.5});

TEST(Nearest, AgreesWithComparingEachWithEach) {
  const Segment i = segment_of(random_cloud(1500, 10, 1)),
                j = segment_of(random_cloud(1500, 10, 2));
  const Matches matches = nearest_pairs(i, j, T_i_j, {1.0, false, {}, {}});
  std::size_t next = 0;
  const Motion j_from_i(T_i_j.inverse());
  for (std::uint32_t k = 0; k < i.cloud.size(); ++k) {
    float best = 1;
    std::int64_t nearest = -1;
    for (std::uint32_t n = 0; n < j.cloud.size(); ++n) {
      const float squared = (j_from_i * i.cloud.point(k) - j.cloud.point(n)).squaredNorm();
      if (squared < best || (squared == best && nearest < 0)) best = squared, nearest = n;
    }
    if (nearest < 0) continue;
    ASSERT_LT(next, matches.size());
    EXPECT_EQ(matches.index_p[next], k);
    EXPECT_EQ(matches.index_q[next], nearest);
    EXPECT_EQ(matches.p[next], i.cloud.point(k));
    EXPECT_EQ(matches.q[next], j.cloud.point(static_cast<std::size_t>(nearest)));
    ++next;
  }
  EXPECT_EQ(next, matches.size());
  EXPECT_EQ(matches.found, matches.size());
  EXPECT_EQ(matches.weight, std::vector<float>(matches.size(), 1.0f));
  EXPECT_GT(next, 300u);
  EXPECT_LT(next, 1400u);
}

TEST(Nearest, PairsAMovedCopyWithItself) {
  const Cloud cloud = random_cloud(500, 10, 3);
  Cloud copy;
  for (std::size_t k = 0; k < cloud.size(); ++k) copy.add(Motion(T_i_j.inverse()) * cloud.point(k));
  const Matches matches =
      nearest_pairs(segment_of(cloud), segment_of(copy), T_i_j, {0.01, false, {}, {}});
  ASSERT_EQ(matches.size(), 500u);
  EXPECT_EQ(matches.index_p, matches.index_q);
}

TEST(Nearest, FindsNothingBetweenSegmentsFarApart) {
  const Segment s = segment_of(random_cloud(100, 10, 1));
  const Pose far(Eigen::Quaterniond::Identity(), {25, 0, 0});
  EXPECT_EQ(nearest_pairs(s, s, far, {1.0, false, {}, {}}).size(), 0u);
  EXPECT_EQ(nearest_pairs(segment_of({}), s, Pose(), {1.0, false, {}, {}}).size(), 0u);
  EXPECT_EQ(nearest_pairs(s, segment_of({}), Pose(), {1.0, false, {}, {}}).size(), 0u);
}

TEST(Nearest, AsksNoMoreThanMostPointsAndSpreadsThem) {
  const Segment s = segment_of(random_cloud(1000, 10, 1));
  const Matches matches = nearest_pairs(s, s, Pose(), {1.0, false, 100, {}});
  ASSERT_EQ(matches.size(), 100u);
  for (std::uint32_t k = 0; k < 100; ++k) EXPECT_EQ(matches.index_p[k], 10 * k);
  EXPECT_EQ(nearest_pairs(s, s, Pose(), {1.0, false, 5000, {}}).size(), 1000u);
}

TEST(Nearest, GivesTheNormalOfTheOtherPointForPlanes) {
  Cloud cloud = random_cloud(50, 10, 1);
  give_normals(cloud, {0, 0, 1});
  const Matches matches =
      nearest_pairs(segment_of(cloud), segment_of(cloud), Pose(), {1.0, true, {}, {}});
  EXPECT_TRUE(matches.to_plane);
  ASSERT_EQ(matches.normal_q.size(), 50u);
  EXPECT_EQ(matches.normal_q[7], Eigen::Vector3f(0, 0, 1));
}

TEST(Nearest, LeavesOutPlanesOfUnknownNormal) {
  Cloud cloud = random_cloud(50, 10, 1);
  give_normals(cloud, {0, 0, 1});
  cloud.nz[7] = 0;
  const Matches matches =
      nearest_pairs(segment_of(cloud), segment_of(cloud), Pose(), {0.1, true, {}, {}});
  EXPECT_EQ(matches.found, 50u);
  EXPECT_EQ(matches.size(), 49u);
}

TEST(Nearest, DropsPairsWhoseNormalsDifferInTheSameFrame) {
  // Both normals point along i's x axis; in j's coordinates that is another direction.
  Cloud a = random_cloud(50, 10, 1), b;
  for (std::size_t k = 0; k < a.size(); ++k) b.add(Motion(T_i_j.inverse()) * a.point(k));
  give_normals(a, {1, 0, 0});
  give_normals(b, Motion(T_i_j.inverse()).r * Eigen::Vector3f(1, 0, 0));
  const double five_degrees = 5 * std::numbers::pi / 180;
  EXPECT_EQ(
      nearest_pairs(segment_of(a), segment_of(b), T_i_j, {0.1, false, {}, five_degrees}).size(),
      50u);
  give_normals(b, {1, 0, 0});
  const auto none =
      nearest_pairs(segment_of(a), segment_of(b), T_i_j, {0.1, false, {}, five_degrees});
  EXPECT_EQ(none.size(), 0u);
  EXPECT_EQ(none.found, 50u);
}

NearestOptions both_ways(double max, bool to_plane = false,
                         std::optional<std::uint32_t> most = {}) {
  NearestOptions options;
  options.max_correspondence_distance = max;
  options.to_plane = to_plane;
  options.max_points = most;
  options.both_ways = true;
  return options;
}

TEST(NearestBothWays, AgreesWithComparingEachWithEachFromBothSides) {
  const Segment i = segment_of(random_cloud(1500, 10, 1)),
                j = segment_of(random_cloud(1500, 10, 2));
  const Matches matches = nearest_pairs(i, j, T_i_j, both_ways(1.0));
  std::vector<std::pair<std::uint32_t, std::uint32_t>> found, expected;
  for (std::size_t k = 0; k < matches.size(); ++k) {
    found.emplace_back(matches.index_p[k], matches.index_q[k]);
    ASSERT_EQ(matches.p[k], i.cloud.point(matches.index_p[k]));
    ASSERT_EQ(matches.q[k], j.cloud.point(matches.index_q[k]));
  }
  const auto ask = [&](const Cloud& of, const Cloud& near, const Pose& near_from_of, bool of_is_i) {
    for (std::uint32_t k = 0; k < of.size(); ++k) {
      double best = 1;
      std::int64_t nearest = -1;
      for (std::uint32_t n = 0; n < near.size(); ++n) {
        const double squared =
            (near_from_of * of.point(k).cast<double>() - near.point(n).cast<double>())
                .squaredNorm();
        if (squared < best) best = squared, nearest = n;
      }
      const auto n = static_cast<std::uint32_t>(nearest);
      if (nearest >= 0) expected.emplace_back(of_is_i ? k : n, of_is_i ? n : k);
    }
  };
  ask(i.cloud, j.cloud, T_i_j.inverse(), true);
  const std::size_t one_way = expected.size();
  ask(j.cloud, i.cloud, T_i_j, false);
  ASSERT_GT(one_way, 300u);
  ASSERT_GT(expected.size(), one_way + 300);
  EXPECT_EQ(found, expected);
  EXPECT_EQ(matches.found, matches.size());
  EXPECT_EQ(matches.weight, std::vector<float>(matches.size(), 1.0f));
}

TEST(NearestBothWays, FindsTheSamePairsWhenTheSegmentsChangePlaces) {
  const Segment i = segment_of(random_cloud(800, 10, 1)), j = segment_of(random_cloud(800, 10, 2));
  const auto sorted = [](const std::vector<std::uint32_t>& a, const std::vector<std::uint32_t>& b) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
    for (std::size_t k = 0; k < a.size(); ++k) pairs.emplace_back(a[k], b[k]);
    std::ranges::sort(pairs);
    return pairs;
  };
  const Matches one = nearest_pairs(i, j, T_i_j, both_ways(1.0)),
                other = nearest_pairs(j, i, T_i_j.inverse(), both_ways(1.0));
  EXPECT_GT(one.size(), 200u);
  EXPECT_EQ(sorted(one.index_p, one.index_q), sorted(other.index_q, other.index_p));
}

TEST(NearestBothWays, AsksHalfAsManyPointsEachWay) {
  const Segment i = segment_of(random_cloud(1000, 10, 1)), j = segment_of(random_cloud(600, 10, 2));
  const Matches matches =
      nearest_pairs(i, j, Pose(), both_ways(30, false, 100));  // 30 m: everyone finds one
  ASSERT_EQ(matches.size(), 100u);
  for (std::uint32_t k = 0; k < 50; ++k) {
    EXPECT_EQ(matches.index_p[k], 20 * k) << "of i's 1000";
    EXPECT_EQ(matches.index_q[50 + k], 12 * k) << "of j's 600";
  }
}

TEST(NearestBothWays, GivesThePlaneOfTheAskedPointInTheAxesOfJ) {
  // Walls of i and j, each the other's moved copy; only where j asks does i's normal count, turned
  // to j.
  const Cloud cloud = random_cloud(50, 10, 1);
  Cloud a = cloud, b;
  for (std::size_t k = 0; k < cloud.size(); ++k) b.add(Motion(T_i_j.inverse()) * cloud.point(k));
  const Eigen::Vector3f of_i = Eigen::Vector3f(1, 2, 2) / 3, of_j(0, 0, 1);
  give_normals(a, of_i);
  give_normals(b, of_j);
  const Matches matches = nearest_pairs(segment_of(a), segment_of(b), T_i_j, both_ways(0.1, true));
  ASSERT_EQ(matches.size(), 100u);
  ASSERT_EQ(matches.normal_q.size(), 100u);
  const Eigen::Vector3f turned = (T_i_j.matrix().transpose() * of_i.cast<double>()).cast<float>();
  for (std::size_t k = 0; k < 50; ++k) {
    EXPECT_EQ(matches.normal_q[k], of_j);
    EXPECT_LT((matches.normal_q[50 + k] - turned).norm(), 1e-6);
    EXPECT_EQ(matches.index_p[50 + k], matches.index_q[50 + k]);
  }
}

TEST(NearestBothWays, LeavesOutPlanesOfUnknownNormalOnTheSideThatIsAsked) {
  Cloud a = random_cloud(50, 10, 1), b = a;
  give_normals(a, {0, 0, 1});
  give_normals(b, {0, 0, 1});
  a.nz[7] = 0;
  const Matches matches = nearest_pairs(segment_of(a), segment_of(b), Pose(), both_ways(0.1, true));
  EXPECT_EQ(matches.found, 100u);
  ASSERT_EQ(matches.size(), 99u);
  EXPECT_EQ(std::ranges::count(matches.index_p, 7u), 1);
}

TEST(NearestBothWays, NeedsNormalsOfTheFirstSegmentTooForPlanes) {
  Cloud with = random_cloud(20, 5, 1);
  give_normals(with, {0, 0, 1});
  const auto wired = [&](bool both) {
    StepUnderTest step(*plumb_module());
    step.over("edges")
        .ends("segments", segment_of(random_cloud(20, 5, 1)), segment_of(with))
        .part("poses", Pose());
    return step.set("metric", std::string("plane")).set("both_ways", both);
  };
  TestContext context;
  EXPECT_THAT(io::refusal([&] { wired(true).run<Matches>("matches", context); }),
              testing::HasSubstr("both_ways"));
  EXPECT_NO_THROW(wired(false).run<Matches>("matches", context));
}

TEST(Nearest, RefusesWhatNeedsNormalsWithoutThemAndNamesTheCure) {
  const Segment bare = segment_of(random_cloud(20, 5, 1));
  TestContext context;
  const auto run = [&](const char* parameter, ParameterValue value) {
    StepUnderTest step(*plumb_module());
    step.over("edges")
        .ends("segments", bare, bare)
        .part("poses", Pose())
        .set(parameter, std::move(value));
    step.run<Matches>("matches", context);
  };
  EXPECT_THAT(io::refusal([&] { run("metric", std::string("plane")); }),
              testing::HasSubstr("estimate.normals"));
  EXPECT_THAT(io::refusal([&] { run("max_normal_angle", 0.5); }),
              testing::HasSubstr("estimate.normals"));
  EXPECT_NO_THROW(run("metric", std::string("point")));
}

}  // namespace
}  // namespace plumb::match_nearest
