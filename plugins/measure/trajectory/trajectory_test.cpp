#include <gmock/gmock.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "plumb/plugin/module.hpp"
#include "plumb/plugin/testing.hpp"
#include "plumb/slam/io/trajectory_file.hpp"
#include "plumb/slam/step.hpp"

extern "C" const PlumbModule* plumb_module();

namespace plumb::measure_trajectory {
namespace {

Trajectory curve(std::size_t frames, double first_stamp = 100) {
  Trajectory t;
  for (std::size_t k = 0; k < frames; ++k) {
    const double s = static_cast<double>(k);
    t.stamps.push_back(first_stamp + 0.1 * s);
    t.T_world_frame.push_back({exp_rotation({0, 0, 0.02 * s}), {s, 0.02 * s * s, 0.1 * s}});
  }
  return t;
}

class MeasureTrajectoryTest : public testing::Test {
 protected:
  void SetUp() override { std::ofstream(file_) << tum_text(curve(50)); }
  void TearDown() override { std::filesystem::remove(file_); }

  Metrics measured(const std::vector<std::pair<std::string, Trajectory>>& trajectories,
                   bool with_truth = true) {
    const Step& step = *plumb_module()->steps[0];
    PortInput input;
    input.wired = true;
    for (const auto& [label, trajectory] : trajectories)
      input.several.push_back({label, any_value(trajectory)});
    ParameterValues values;
    if (with_truth) values["truth"] = file_.string();
    PortOutput output;
    step.run(step.parameters(values).get(), {&input, 1}, {&output, 1}, context_);
    return *output.one.as<Metrics>();
  }

  std::filesystem::path file_ = std::filesystem::temp_directory_path() /
                                ("plumb_truth_" + std::to_string(::getpid()) + ".tum");
  TestContext context_;
};

TEST_F(MeasureTrajectoryTest, FindsNoErrorInAMovedTruth) {
  auto moved = curve(50);
  const Pose motion(exp_rotation({0.3, 0.2, -1}), {100, 200, 5});
  for (auto& pose : moved.T_world_frame) pose = motion * pose;
  const auto metrics = measured({{"", moved}});
  ASSERT_EQ(metrics.numbers.size(), 6u);
  EXPECT_EQ(metrics.numbers[0].name, "ate");
  for (const auto& number : metrics.numbers) EXPECT_NEAR(number.value, 0, 1e-6) << number.name;
}

TEST_F(MeasureTrajectoryTest, NamesNumbersByTheirLabels) {
  auto bent = curve(50);
  for (auto& pose : bent.T_world_frame)
    pose.translation.y() += 0.001 * pose.translation.x() * pose.translation.x();
  const auto metrics = measured({{"before", bent}, {"after", curve(50)}});
  ASSERT_EQ(metrics.numbers.size(), 12u);
  EXPECT_EQ(metrics.numbers[0].name, "before.ate");
  EXPECT_EQ(metrics.numbers[6].name, "after.ate");
  EXPECT_GT(metrics.numbers[0].value, 0.1);
  EXPECT_LT(metrics.numbers[6].value, 1e-6);
}

TEST_F(MeasureTrajectoryTest, GivesTheDisplacementAlongTheTruthsAxesFromTheFirstPoseOn) {
  // Seen from the first pose the k-th position lies k * 1 mm too far along x and k * 2 mm too
  // little along y.
  auto bent = curve(50);
  const Pose motion(exp_rotation({0, 0, -2}), {30, -20, 0});
  for (std::size_t k = 0; k < 50; ++k) {
    const double s = static_cast<double>(k);
    bent.T_world_frame[k].translation += Eigen::Vector3d(0.001 * s, -0.002 * s, 0.5 * s);
    bent.T_world_frame[k] = motion * bent.T_world_frame[k];
  }
  const auto metrics = measured({{"", bent}});
  EXPECT_EQ(metrics.numbers[4].name, "displacement_x");
  EXPECT_NEAR(metrics.numbers[4].value, 0.001 * 24.5, 1e-6);
  EXPECT_EQ(metrics.numbers[5].name, "displacement_y");
  EXPECT_NEAR(metrics.numbers[5].value, 0.002 * 24.5, 1e-6);
}

TEST_F(MeasureTrajectoryTest, SaysThatThereIsNoTruth) {
  const auto metrics = measured({{"", curve(5)}}, false);
  EXPECT_TRUE(metrics.numbers.empty());
  EXPECT_THAT(metrics.notes, testing::ElementsAre(testing::HasSubstr("no truth was given")));
}

TEST_F(MeasureTrajectoryTest, SaysThatStampsDoNotMeet) {
  const auto metrics = measured({{"odd", curve(50, 5000)}});
  EXPECT_TRUE(metrics.numbers.empty());
  EXPECT_THAT(
      context_.warnings,
      testing::ElementsAre(testing::HasSubstr("poses of 'odd' with a stamp of the truth: only 0")));
}

}  // namespace
}  // namespace plumb::measure_trajectory
