#include "relations.hpp"

#include <gmock/gmock.h>

#include <numbers>

#include "plumb/data/io/file_testing.hpp"
#include "plumb/plugin/step_testing.hpp"
#include "plumb/slam/step.hpp"
#include "plumb/slam/types.hpp"

namespace plumb::measure_relations {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

Pose planar(double x, double y, double theta) { return {exp_rotation({0, 0, theta}), {x, y, 0}}; }

/// A round trip; its stamps step back at every tenth frame.
Trajectory trip(std::size_t frames) {
  Trajectory t;
  for (std::size_t k = 0; k < frames; ++k) {
    const auto s = static_cast<double>(k);
    t.stamps.push_back(1000 + 0.2 * s - (k % 10 == 9 ? 0.5 : 0));
    t.T_world_frame.push_back(planar(std::cos(0.1 * s), 2 * std::sin(0.1 * s), 0.3 * s));
  }
  return t;
}

std::map<std::string, double> measured(const Trajectory& trajectory, const std::string& relations,
                                       TestContext& context) {
  const io::TestFolder folder;
  StepUnderTest step(*plumb_module());
  step.add("trajectories", "after", trajectory)
      .set("relations", folder.write("r.relations", relations).string());
  std::map<std::string, double> numbers;
  for (const auto& number : step.run<Metrics>("metrics", context).numbers)
    numbers[number.name] = number.value;
  return numbers;
}

TEST(MeasureRelations, FindsNoErrorInTheRelationsOfTheTrajectoryItself) {
  const Trajectory t = trip(100);
  std::vector<TrueRelation> relations;
  for (std::size_t i = 0; i < 100; ++i)
    for (const std::size_t j : {(i * 7) % 100, (i * 31) % 100})
      relations.push_back(
          {t.stamps[i], t.stamps[j], t.T_world_frame[i].inverse() * t.T_world_frame[j]});
  const auto errors = relation_errors(relations, t, 0.01);
  EXPECT_EQ(errors.used, 200u);
  EXPECT_LT(errors.translation.mean, 1e-12);
  EXPECT_LT(errors.rotation.mean, 1e-9);
}

TEST(MeasureRelations, DoesNotSeeAMotionOfTheWholeTrajectory) {
  Trajectory t = trip(50);
  const std::vector<TrueRelation> relations = {{t.stamps[3], t.stamps[20], planar(1, 2, 0.3)},
                                               {t.stamps[7], t.stamps[8], Pose()}};
  const auto before = relation_errors(relations, t, 0.1);
  for (auto& pose : t.T_world_frame) pose = Pose(exp_rotation({0.1, -0.3, 2}), {5, -9, 3}) * pose;
  const auto after = relation_errors(relations, t, 0.1);
  EXPECT_NEAR(after.translation.mean, before.translation.mean, 1e-12);
  EXPECT_NEAR(after.rotation.deviation, before.rotation.deviation, 1e-12);
}

TEST(MeasureRelations, GivesMeanAndDeviationOfAbsoluteAndSquaredErrors) {
  Trajectory t;
  t.stamps = {1, 2, 3};
  t.T_world_frame = {planar(0, 0, 0), planar(1, 0, 0), planar(1, 0, 0.5)};
  TestContext context;
  // Errors: 1 m and none; 3 m and 0.5 rad.
  auto numbers = measured(t, "# truth\n1 2 0 0 0 0 0 0\n2.1 2.95 3 0 0 0 0 0\n", context);
  EXPECT_NEAR(numbers["after.translation"], 2, 1e-12);
  EXPECT_NEAR(numbers["after.translation_deviation"], 1, 1e-12);
  EXPECT_NEAR(numbers["after.translation_squared"], 5, 1e-12);
  EXPECT_NEAR(numbers["after.translation_squared_deviation"], 4, 1e-12);
  EXPECT_NEAR(numbers["after.rotation"], 0.25, 1e-12);
  EXPECT_NEAR(numbers["after.rotation_squared"], 0.125, 1e-12);
  EXPECT_EQ(numbers["after.relations"], 2);
  EXPECT_TRUE(context.warnings.empty());
}

TEST(MeasureRelations, TurnsByRollThenPitchThenYaw) {
  const io::TestFolder folder;
  const auto file = read_relations(folder.write("r", "0 1 1 2 3 0.1 0.2 0.3 and more\n"));
  const Eigen::Matrix3d expected = (Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitZ()) *
                                    Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitY()) *
                                    Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitX()))
                                       .toRotationMatrix();
  ASSERT_EQ(file.relations.size(), 1u);
  EXPECT_LT((file.relations[0].T_from_to.matrix() - expected).norm(), 1e-12);
  EXPECT_EQ(file.relations[0].T_from_to.translation, Eigen::Vector3d(1, 2, 3));
}

TEST(NearestStamp, IsTheFirstOfThoseNearestByValue) {
  Random random(7);
  std::vector<double> stamps;
  for (int k = 0; k < 300; ++k)
    stamps.push_back(0.25 * random.below(200));  // with repetitions, in no order
  const NearestStamp nearest(stamps);
  for (double stamp = -1; stamp < 52; stamp += 0.0625) {
    std::size_t best = 0;
    for (std::size_t k = 1; k < stamps.size(); ++k)
      if (std::abs(stamps[k] - stamp) < std::abs(stamps[best] - stamp)) best = k;
    EXPECT_EQ(nearest.of(stamp), best) << stamp;
  }
}

TEST(MeasureRelations, LeavesOutMomentsWithoutAFrameAndSaysSo) {
  TestContext context;
  auto numbers = measured(trip(20), "1000 1001 1 0 0 0 0 0\n1000 1010 1 0 0 0 0 0\n1 2\n", context);
  EXPECT_EQ(numbers["after.relations"], 1);
  EXPECT_EQ(context.counts["lines of the relations with fewer than 8 words left out"], 1u);
  EXPECT_THAT(context.warnings,
              ElementsAre(HasSubstr("1 of 2 relations have no frame of 'after'")));
  EXPECT_TRUE(measured(trip(20), "5 6 1 0 0 0 0 0\n", context).empty());
}

TEST(MeasureRelations, SaysThatThereAreNone) {
  TestContext context;
  const auto metrics = StepUnderTest(*plumb_module())
                           .add("trajectories", "", trip(3))
                           .run<Metrics>("metrics", context);
  EXPECT_TRUE(metrics.numbers.empty());
  EXPECT_THAT(metrics.notes, ElementsAre(HasSubstr("no relations were given")));
}

TEST(MeasureRelations, RefusesAFileThatIsNone) {
  const io::TestFolder folder;
  const auto said = [&](const std::string& text) {
    return io::refusal([&] { read_relations(folder.write("r", text)); });
  };
  EXPECT_THAT(said("1 2 x 0 0 0 0 0\n"),
              HasSubstr("r:1: expected 'from to x y z roll pitch yaw', found 'x'"));
  EXPECT_THAT(said("1 2 nan 0 0 0 0 0\n"), HasSubstr("found 'nan'"));
  EXPECT_THAT(said(""), HasSubstr("holds no relation"));
  EXPECT_THAT(io::refusal([] { read_relations("/no/such"); }), HasSubstr("cannot be opened"));
}

}  // namespace
}  // namespace plumb::measure_relations
