#include "plumb/slam/step.hpp"

#include "plumb/data/io/file_testing.hpp"
#include "plumb/plugin/step_testing.hpp"
#include "plumb/slam/trajectory.hpp"

namespace plumb::source_trajectory {
namespace {

TEST(SourceTrajectory, GivesTheFilesPosesInItsOrder) {
  const io::TestFolder folder;
  const auto file = folder.write("a.tum", "2 1 0 0 0 0 0 1\n# noted\n1.5 1 2 0 0 0 1 0\n");
  TestContext context;
  StepUnderTest step(*plumb_module());
  const auto read = step.set("path", file.string()).run<Trajectory>("trajectory", context);
  EXPECT_EQ(read.stamps, (std::vector<double>{2, 1.5}));
  EXPECT_EQ(read.T_world_frame[1].translation, Eigen::Vector3d(1, 2, 0));
  EXPECT_NEAR(std::abs(read.T_world_frame[1].rotation.z()), 1, 1e-12);
}

TEST(SourceTrajectory, RefusesWhatIsNone) {
  const io::TestFolder folder;
  TestContext context;
  StepUnderTest step(*plumb_module());
  step.set("path", folder.write("a.tum", "hello\n").string());
  EXPECT_THROW(step.run<Trajectory>("trajectory", context), Error);
}

}  // namespace
}  // namespace plumb::source_trajectory
