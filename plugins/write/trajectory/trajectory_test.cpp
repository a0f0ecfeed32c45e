#include <gmock/gmock.h>

#include <sstream>

#include "plumb/data/document.hpp"
#include "plumb/plugin/module.hpp"
#include "plumb/plugin/testing.hpp"
#include "plumb/slam/step.hpp"

extern "C" const PlumbModule* plumb_module();

namespace plumb::write_trajectory {
namespace {

Document written(const ParameterValues& values, std::vector<double> stamps = {1.5, 2.25}) {
  const Step& step = *plumb_module()->steps[0];
  Trajectory trajectory;
  trajectory.stamps = std::move(stamps);
  trajectory.T_world_frame = {Pose(),
                              Pose(Eigen::Quaterniond(0, 0, 0, 1), Eigen::Vector3d(1, -2, 3))};
  PortInput input;
  input.wired = true;
  input.one = any_value(trajectory);
  PortOutput output;
  TestContext context;
  step.run(step.parameters(values).get(), {&input, 1}, {&output, 1}, context);
  return *output.one.as<Document>();
}

TEST(WriteTrajectory, WritesALineAFrameWithStampPositionAndQuaternion) {
  const auto document = written({});
  EXPECT_EQ(document.name, "trajectory.tum");
  std::istringstream lines(document.bytes.text());
  double v[16];
  for (double& x : v) ASSERT_TRUE(lines >> x);
  EXPECT_THAT(std::vector<double>(v, v + 8), testing::ElementsAre(1.5, 0, 0, 0, 0, 0, 0, 1));
  EXPECT_THAT(std::vector<double>(v + 8, v + 16), testing::ElementsAre(2.25, 1, -2, 3, 0, 0, 1, 0));
}

TEST(WriteTrajectory, KeepsTheOrderOfFramesWhereStampsStepBack) {
  const auto lines = written({}, {976052857.5, 976052857.25}).bytes.text();
  EXPECT_TRUE(lines.starts_with("976052857.500000 "));
  EXPECT_THAT(lines, testing::HasSubstr("\n976052857.250000 "));
}

TEST(WriteTrajectory, WritesMatricesForKitti) {
  const auto document = written({{"format", std::string("kitti")}, {"name", std::string("p.txt")}});
  EXPECT_EQ(document.name, "p.txt");
  std::istringstream lines(document.bytes.text());
  std::vector<double> v(24);
  for (double& x : v) ASSERT_TRUE(lines >> x);
  EXPECT_EQ(std::vector<double>(v.begin() + 12, v.end()),
            (std::vector<double>{-1, 0, 0, 1, 0, -1, 0, -2, 0, 0, 1, 3}));
}

TEST(WriteTrajectory, RefusesANameWithAFolder) {
  const Step& step = *plumb_module()->steps[0];
  EXPECT_THROW(step.parameters({{"name", std::string("../x.tum")}}), Error);
}

}  // namespace
}  // namespace plumb::write_trajectory
