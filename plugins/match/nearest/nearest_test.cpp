#include "nearest.hpp"

#include <gmock/gmock.h>

#include <numbers>

#include "plumb/plugin/step_testing.hpp"

namespace plumb {
namespace {

Segment segment_of(Cloud cloud) {
  std::vector<std::uint16_t> frames(cloud.size(), 0);
  return Segment().with(std::move(cloud), std::move(frames));
}
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

TEST(Nearest, RefusesWhatNeedsNormalsWithoutThemAndNamesTheCure) {
  const Segment bare = segment_of(random_cloud(20, 5, 1));
  const auto refusal = [&](const char* parameter, ParameterValue value) -> std::string {
    StepRun step(*plumb_module());
    step.over("edges")
        .ends("segments", bare, bare)
        .at("poses", Pose())
        .set(parameter, std::move(value));
    TestContext context;
    try {
      step.run<Matches>("matches", context);
    } catch (const Error& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_THAT(refusal("metric", std::string("plane")), testing::HasSubstr("estimate.normals"));
  EXPECT_THAT(refusal("reject_normals", 0.5), testing::HasSubstr("estimate.normals"));
  EXPECT_EQ(refusal("metric", std::string("point")), "");
}

}  // namespace
}  // namespace plumb
