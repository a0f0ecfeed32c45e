#include <gmock/gmock.h>

#include <map>

#include "agreement.hpp"
#include "plumb/data/io/file_testing.hpp"
#include "plumb/plugin/step_testing.hpp"
#include "plumb/slam/cloud_testing.hpp"
#include "plumb/slam/step.hpp"

namespace plumb::accept_poses {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

void add(Cloud& cloud, const Eigen::Vector3f& p, const Eigen::Vector3f& n) {
  cloud.add(p);
  cloud.nx.push_back(n.x());
  cloud.ny.push_back(n.y());
  cloud.nz.push_back(n.z());
}
Cloud random_cloud(std::size_t count, bool normals, std::uint64_t seed) {
  Random random(seed);
  const auto vector = [&] {
    return Eigen::Vector3f::NullaryExpr(
        [&](Eigen::Index) { return static_cast<float>(2 * random.uniform() - 1); });
  };
  Cloud cloud;
  for (std::size_t k = 0; k < count; ++k) {
    const Eigen::Vector3f p = 5 * vector(), n = k % 10 == 0
                                                    ? Eigen::Vector3f::Zero()
                                                    : Eigen::Vector3f(vector().normalized());
    if (normals)
      add(cloud, p, n);
    else
      cloud.add(p);
  }
  return cloud;
}
/// A floor and two walls that cross over its middle, 10 m wide and 3 m high.
Cloud crossing() {
  Random random(1);
  const auto u = [&](double low, double high) {
    return static_cast<float>(low + (high - low) * random.uniform());
  };
  Cloud cloud;
  for (int k = 0; k < 500; ++k) {
    add(cloud, {u(-5, 5), u(-5, 5), 0}, {0, 0, 1});
    add(cloud, {0, u(-5, 5), u(0, 3)}, {1, 0, 0});
    add(cloud, {u(-5, 5), 0, u(0, 3)}, {0, 1, 0});
  }
  return cloud;
}
/// A part of the wall across x.
Cloud wall(double from, double to) {
  Random random(2);
  Cloud cloud;
  for (int k = 0; k < 400; ++k)
    add(cloud,
        {0, static_cast<float>(from + (to - from) * random.uniform()),
         static_cast<float>(1 + random.uniform())},
        {1, 0, 0});
  return cloud;
}
Pose shifted(double x, double y, double z) { return {Eigen::Quaterniond::Identity(), {x, y, z}}; }
/// Of the points that one pose alone chooses.
double disagreement_at(const Segment& i, const Segment& j, const Pose& T_j_i,
                       const AgreementOptions& options) {
  return disagreement(i, j, common_points(i, j, T_j_i, T_j_i, options), T_j_i, options);
}
bool in_box(const Segment& j, const Eigen::Vector3d& p, double margin) {
  return ((p - j.box.low.cast<double>()).array() >= -margin).all() &&
         ((p - j.box.high.cast<double>()).array() <= margin).all();
}

TEST(CommonPoints, LieInTheWidenedBoxUnderOneOfThePosesAtLeast) {
  const Segment i = segment_of(random_cloud(1000, false, 1)),
                j = segment_of(random_cloud(1000, false, 2));
  const Pose before(exp_rotation({0.1, -0.2, 0.7}), {7, -1, 0.5}),
      after(exp_rotation({0, 0.1, 0.2}), {-6, 3, 0});
  std::vector<std::uint32_t> expected;
  for (std::uint32_t k = 0; k < i.cloud.size(); ++k) {
    const Eigen::Vector3d p = i.cloud.point(k).cast<double>();
    if (in_box(j, before * p, 0.8) || in_box(j, after * p, 0.8)) expected.push_back(k);
  }
  ASSERT_GT(expected.size(), 300u);
  ASSERT_LT(expected.size(), 1000u);
  EXPECT_EQ(common_points(i, j, before, after, {0.8, 10000}), expected);
  EXPECT_EQ(common_points(i, j, after, before, {0.8, 10000}), expected);
  const auto few = common_points(i, j, before, after, {0.8, 50});
  EXPECT_EQ(few.size(), 50u);
  EXPECT_EQ(few, common_points(i, j, after, before, {0.8, 50}));
}

TEST(Disagreement, IsHowFarAWallLiesOffAndNothingAlongIt) {
  const Segment i = segment_of(wall(1, 3)), j = segment_of(crossing());
  EXPECT_NEAR(disagreement_at(i, j, Pose(), {}), 0, 1e-6);
  EXPECT_NEAR(disagreement_at(i, j, shifted(0.2, 0, 0), {}), 0.2, 1e-6);
  EXPECT_NEAR(disagreement_at(i, j, shifted(-0.3, 1, 0.2), {}), 0.3, 1e-6);
}

TEST(Disagreement, AgreesWithComparingEachWithEach) {
  const Pose T_j_i(exp_rotation({0.1, -0.2, 0.7}), {2, -1, 0.5});
  for (const bool normals : {false, true}) {
    const Segment i = segment_of(random_cloud(600, normals, 1)),
                  j = segment_of(random_cloud(600, normals, 2));
    const AgreementOptions all{0.8, 10000};
    double sum = 0;
    int inside = 0;
    for (std::size_t k = 0; k < i.cloud.size(); ++k) {
      const Eigen::Vector3d p = T_j_i * i.cloud.point(k).cast<double>();
      if (!in_box(j, p, all.max_distance)) continue;
      double nearest = 1e9, distance = 0;
      for (std::size_t n = 0; n < j.cloud.size(); ++n) {
        const Eigen::Vector3d d = p - j.cloud.point(n).cast<double>();
        if (d.norm() >= nearest) continue;
        nearest = d.norm();
        const bool plane = normals && !j.cloud.normal(n).isZero();
        distance = plane ? std::abs(j.cloud.normal(n).cast<double>().dot(d)) : nearest;
      }
      sum += nearest > all.max_distance ? all.max_distance : distance;
      ++inside;
    }
    ASSERT_GT(inside, 200);
    ASSERT_LT(inside, 600);
    EXPECT_NEAR(disagreement_at(i, j, T_j_i, all), sum / inside, 1e-5);
  }
}

TEST(Disagreement, CountsAPointFarFromAllAsTheMostDistance) {
  Cloud corners;  // a box of 10 m with points at two corners only
  corners.add({-5, -5, -5});
  corners.add({5, 5, 5});
  Cloud points;
  points.add({0, 0, 0});
  points.add({5, 5, 4.5});
  EXPECT_NEAR(disagreement_at(segment_of(points), segment_of(corners), Pose(), {2, 300}),
              (2 + 0.5) / 2, 1e-6);
}

TEST(Disagreement, SeesAFlatCloudThatLiesOutsideTheOthersFlatBox) {
  Random random(3);
  Cloud floor;
  for (int k = 0; k < 400; ++k)
    add(floor,
        {static_cast<float>(10 * random.uniform()), static_cast<float>(10 * random.uniform()), 0},
        {0, 0, 1});
  const Segment s = segment_of(floor);
  EXPECT_NEAR(disagreement_at(s, s, shifted(0, 0, 0.3), {1, 300}), 0.3, 1e-6);
}

TEST(Disagreement, IsNegativeWhereNoPointLiesInTheOthersWidenedBox) {
  const Segment s = segment_of(crossing()), none = segment_of({});
  EXPECT_LT(disagreement_at(s, s, shifted(30, 0, 0), {}), 0);
  EXPECT_LT(disagreement_at(none, s, Pose(), {}), 0);
  EXPECT_LT(disagreement_at(s, none, Pose(), {}), 0);
}

TEST(Disagreement, AsksPointsHalfwayBetweenThoseThatEvenlySpacedPairsTake) {
  const Segment j = segment_of(crossing());
  Cloud cloud =
      wall(1, 3);  // 400 points; pairs of 40 of them take each tenth from the first one on
  for (std::size_t k = 0; k < cloud.size(); ++k) cloud.x[k] = k % 10 == 5 ? 0.4f : 0.0f;
  EXPECT_NEAR(disagreement_at(segment_of(cloud), j, Pose(), {1, 40}), 0.4, 1e-6);
  for (std::size_t k = 0; k < cloud.size(); ++k) cloud.x[k] = k % 10 == 0 ? 0.4f : 0.0f;
  EXPECT_NEAR(disagreement_at(segment_of(cloud), j, Pose(), {1, 40}), 0, 1e-6);
}

// ---- the step
// ---------------------------------------------------------------------------------------------------------------------

/// Four segments that see the same crossing from the same place, joined to a ring.
struct Stage {
  std::vector<Segment> segments = std::vector<Segment>(4, segment_of(crossing()));
  Edges edges{4,
              {{0, 1, EdgeKind::sequential, 1, 0},
               {0, 3, EdgeKind::loop, 1, 0},
               {1, 2, EdgeKind::sequential, 1, 0},
               {2, 3, EdgeKind::sequential, 1, 0}}};
  Poses before = off({0, 0, 0, 0}), after = off({0, 0, 0, 0});

  static Poses off(const std::vector<double>& y) {
    Poses poses;
    for (const double metres : y) poses.T_world_segment.push_back(shifted(0, metres, 0));
    return poses;
  }
  StepUnderTest step() const {
    StepUnderTest run(*plumb_module());
    run.with("before", before).with("after", after).with("edges", edges).each("segments", segments);
    return run;
  }
  Metrics metrics() const {
    TestContext context;
    return step().run<Metrics>("metrics", context);
  }
  bool takes_after() const {
    TestContext context;
    const auto poses = step().run<Poses>("poses", context);
    const bool accepted = metrics().numbers[0].value == 1;
    const auto& expected = accepted ? after : before;
    for (std::size_t k = 0; k < expected.size(); ++k)
      EXPECT_EQ(poses.T_world_segment[k].translation, expected.T_world_segment[k].translation);
    return accepted;
  }
};

TEST(AcceptPoses, TakesAStageThatBroughtTheSegmentsTogether) {
  Stage stage;
  stage.before = Stage::off({0, 0.2, 0.1, 0.3});
  EXPECT_TRUE(stage.takes_after());
  EXPECT_THAT(stage.metrics().notes, IsEmpty());
}

TEST(AcceptPoses, KeepsThePosesOfBeforeWhereTheStageTookThemApartAndSaysSo) {
  Stage stage;
  stage.after = Stage::off({0, 0.2, 0.1, 0.3});
  EXPECT_FALSE(stage.takes_after());
  ASSERT_EQ(stage.metrics().notes.size(), 1u);
  EXPECT_THAT(stage.metrics().notes[0], HasSubstr("0.0000 m from the neighbours' surfaces before"));
  EXPECT_THAT(stage.metrics().notes[0], HasSubstr("(consecutive segments)"));
}

TEST(AcceptPoses, KeepsThePosesOfBeforeWhereOnlyOtherEdgesGotWorse) {
  Stage stage;
  stage.before = Stage::off({0, 0.3, 0, 0});  // consecutive ones 0.3 m off, the loop closed
  stage.after = Stage::off({0, 0.05, 0.1, 0.15});
  EXPECT_FALSE(stage.takes_after());
  ASSERT_EQ(stage.metrics().notes.size(), 1u);
  EXPECT_THAT(stage.metrics().notes[0], HasSubstr("(other edges)"));
  stage.edges.list.erase(stage.edges.list.begin() + 1);
  EXPECT_TRUE(stage.takes_after());
}

TEST(AcceptPoses, TakesWhatIsWorseByNoMoreThanTheTolerance) {
  Stage stage;
  stage.before = Stage::off({0, 0.3, 0, 0.3});
  const auto accepted = [&](double y, double tolerance) {
    stage.after = Stage::off({0, y, 0, y});
    TestContext context;
    auto step = stage.step();
    step.set("max_points", std::int64_t(100000))
        .set("tolerance", tolerance);  // all points, so that samples do not differ
    return step.run<Metrics>("metrics", context).numbers[0].value == 1;
  };
  EXPECT_TRUE(accepted(0.303, 0.03));
  EXPECT_FALSE(accepted(0.303, 0));
  EXPECT_FALSE(accepted(0.33, 0.03));
  EXPECT_TRUE(accepted(0.33, 0.2));
}

TEST(AcceptPoses, TakesPosesThatAreTheSame) {
  Stage stage;
  stage.before = stage.after = Stage::off({0, 0.2, 0.1, 0.3});
  EXPECT_TRUE(stage.takes_after());
}

TEST(AcceptPoses, DoesNotTakeSegmentsThatWereTornApart) {
  Stage stage;
  stage.before = Stage::off({0, 0.2, 0.1, 0.3});
  stage.after = Stage::off({0, 100, 200, 300});
  EXPECT_FALSE(stage.takes_after());
  const auto numbers = stage.metrics().numbers;
  ASSERT_EQ(numbers.size(), 5u);
  EXPECT_EQ(numbers[2].name, "sequential_after");
  EXPECT_EQ(numbers[2].value, 1);
  EXPECT_EQ(numbers[4].name, "others_after");
  EXPECT_EQ(numbers[4].value, 1);
}

TEST(AcceptPoses, GivesTheMeanDistancesOfBothClassesBeforeAndAfter) {
  Stage stage;
  stage.before = Stage::off({0, 0.1, 0.1, 0.3});
  std::map<std::string, double> mean;
  for (const auto& number : stage.metrics().numbers) mean[number.name] = number.value;
  const auto of = [&](std::size_t i, std::size_t j) {
    const Segment &a = stage.segments[i], &b = stage.segments[j];
    const Pose T_before = stage.before.relative(j, i);
    return disagreement(a, b, common_points(a, b, T_before, stage.after.relative(j, i), {}),
                        T_before, {});
  };
  EXPECT_NEAR(mean["sequential_before"], (of(0, 1) + of(1, 2) + of(2, 3)) / 3, 1e-12);
  EXPECT_NEAR(mean["others_before"], of(0, 3), 1e-12);
  EXPECT_GT(mean["others_before"], 0.05);
  EXPECT_NEAR(mean["sequential_after"], 0, 1e-6);
}

TEST(AcceptPoses, AsksTheSamePointsUnderBothPoses) {
  // Before, only half of i lies at j, and where j fits; after it all of i does, also where j is 0.5
  // m off. Points chosen for each pose alone would fit before, and the stage would be refused.
  Stage stage;
  Cloud i, j;
  for (int k = 0; k < 200; ++k) {
    add(i, {0.1f * static_cast<float>(k), 0, 0}, {0, 0, 1});
    add(j, {0.1f * static_cast<float>(k), 0, k < 100 ? 0.0f : 0.5f}, {0, 0, 1});
  }
  stage.segments = {segment_of(i), segment_of(j)};
  stage.edges = {2, {{0, 1, EdgeKind::sequential, 1, 0}}};
  stage.before.T_world_segment = {shifted(-10, 0, 0), Pose()};
  stage.after.T_world_segment = {Pose(), Pose()};
  EXPECT_TRUE(stage.takes_after());
  std::map<std::string, double> mean;
  for (const auto& number : stage.metrics().numbers) mean[number.name] = number.value;
  EXPECT_NEAR(mean["sequential_before"], 0.45, 0.02)
      << "90 of 200 points lie more than 1 m before j's first";
  EXPECT_NEAR(mean["sequential_after"], 0.25, 0.02);
}

TEST(AcceptPoses, TakesTheStageWhereNoEdgesTell) {
  Stage stage;
  stage.edges.list.clear();
  stage.after = Stage::off({0, 100, 200, 300});
  EXPECT_TRUE(stage.takes_after());
}

TEST(AcceptPoses, RefusesPosesOrEdgesOfOtherSegments) {
  const auto refusal = [](const Stage& stage) { return io::refusal([&] { stage.metrics(); }); };
  const auto names_the_cure = HasSubstr("wire what belongs to the same segments");
  Stage before, after, edges;
  before.before.T_world_segment.pop_back();
  after.after.T_world_segment.emplace_back();
  edges.edges.segments = 5;
  EXPECT_THAT(refusal(before), names_the_cure);
  EXPECT_THAT(refusal(after), names_the_cure);
  EXPECT_THAT(refusal(edges), names_the_cure);
  EXPECT_NO_THROW(Stage().metrics());
}

TEST(AcceptPoses, MultipliesTheMostDistanceByAScale) {
  Stage stage;
  stage.after = Stage::off({0, 100, 200, 300});
  TestContext context;
  const auto numbers = stage.step()
                           .set("max_distance", 0.8)
                           .with("scale", Metrics().add("scale", 0.5, ""))
                           .run<Metrics>("metrics", context)
                           .numbers;
  EXPECT_NEAR(numbers[2].value, 0.4, 1e-12);
}

}  // namespace
}  // namespace plumb::accept_poses
