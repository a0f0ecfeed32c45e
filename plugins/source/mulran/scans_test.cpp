#include "scans.hpp"

#include <gmock/gmock.h>

#include "plumb/slam/io/source_testing.hpp"

namespace plumb::source_mulran {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

/// Scans at 0.5, 1.5 and 10.5 s after T; scan at s has the point (s, 0, 0). The trajectory goes 2 m
/// a second along x.
struct MulRanFolder : testing::Test {
  static constexpr std::uint64_t second = 1000000000, T = 1567410201ull * second;
  io::TestFolder folder;
  const fs::path& path = folder.path();

  MulRanFolder() {
    for (const std::uint64_t half : {21, 1, 3})
      scan("Ouster/" + std::to_string(T + half * second / 2) + ".bin",
           0.5f * static_cast<float>(half));
    std::string csv, tum;
    for (const int s : {0, 1, 2, 3, 10, 11}) {
      csv += std::to_string(T + static_cast<std::uint64_t>(s) * second) + ",1,0,0," +
             std::to_string(2 * s) + ",0,1,0,0,0,0,1,0\n";
      tum += std::to_string(T / second + static_cast<std::uint64_t>(s)) + " " +
             std::to_string(2 * s) + " 0 0 0 0 0 1\n";
    }
    folder.write("global_pose.csv", csv);
    folder.write("slam.tum", tum);
  }
  void scan(const std::string& name, float x) const {
    const float point[4] = {x, 0, 0, 7};
    folder.write(name, std::string(reinterpret_cast<const char*>(point), sizeof point));
  }
  SourceResult run(const std::string& trajectory, ParameterValues values = {}) const {
    values.emplace("path", path.string());
    values.emplace("trajectory", (path / trajectory).string());
    return read_source(values);
  }
  std::string refusal(const std::string& trajectory, const ParameterValues& values = {}) const {
    return io::refusal([&] { run(trajectory, values); });
  }
};

TEST_F(MulRanFolder, InterpolatesPosesAtTheScansStampsInOrderOfTime) {
  for (const char* trajectory : {"global_pose.csv", "slam.tum"}) {
    auto sequence = run(trajectory);
    ASSERT_EQ(sequence.frames.keys.size(), 3u);
    EXPECT_EQ(sequence.cloud(0).x[0], 0.5f);
    EXPECT_EQ(sequence.cloud(2).x[0], 10.5f);
    EXPECT_NEAR(sequence.trajectory.T_world_frame[0].translation.x(), 1, 1e-5);
    EXPECT_NEAR(sequence.trajectory.T_world_frame[2].translation.x(), 21, 1e-5);
    EXPECT_NEAR(sequence.trajectory.stamps[1] - 1567410201, 1.5, 1e-6);
  }
}

TEST_F(MulRanFolder, LeavesOutScansWithoutPosesAndCountsThem) {
  scan("Ouster/" + std::to_string(T - second) + ".bin", -1);
  scan("Ouster/" + std::to_string(T + 5 * second) + ".bin",
       5);  // 3 s and 10 s are the nearest poses
  scan("Ouster/" + std::to_string(T + 12 * second) + ".bin", 12);
  auto sequence = run("global_pose.csv");
  EXPECT_EQ(sequence.frames.keys.size(), 3u);
  EXPECT_EQ(sequence.count("frames outside the trajectory's time left out"), 2u);
  EXPECT_EQ(sequence.count("frames in gaps of the trajectory left out"), 1u);
  auto all = run("global_pose.csv", {{"max_time_gap", 10.0}});
  ASSERT_EQ(all.frames.keys.size(), 4u);
  EXPECT_NEAR(all.trajectory.T_world_frame[2].translation.x(), 10, 1e-5);
}

TEST_F(MulRanFolder, KeepsAScanAtTheVeryStampOfAPoseBesideAGap) {
  scan("Ouster/" + std::to_string(T + 10 * second) + ".bin", 10);
  EXPECT_EQ(run("global_pose.csv").frames.keys.size(), 4u);
}

TEST_F(MulRanFolder, PutsTheLaserOnTheVehicleWhenPosesAreTheVehicles) {
  const Pose pose =
      run("global_pose.csv", {{"poses_of", std::string("vehicle")}}).trajectory.T_world_frame[0];
  EXPECT_LT((pose.translation - Eigen::Vector3d(1 + 1.7042, -0.021, 1.8047)).norm(), 1e-5);
  EXPECT_LT((pose * Eigen::Vector3d(1, 0, 0) - pose.translation - Eigen::Vector3d(-1, 0, 0)).norm(),
            0.01);  // looks back
}

TEST_F(MulRanFolder, ReadsScansWithoutAFolderOfTheirOwn) {
  fs::rename(path / "Ouster", path / "scans");
  EXPECT_EQ(run("slam.tum", {{"path", (path / "scans").string()}}).frames.keys.size(), 3u);
}

TEST_F(MulRanFolder, OrdersStampsAsNumbers) {
  for (const char* name : {"short/1000000000.bin", "short/999999999.bin"}) scan(name, 0);
  const auto scans = scans_of(path / "short");
  EXPECT_EQ(scans[0].file.name, "999999999.bin");
  EXPECT_EQ(scans[1].stamp, 1.0);
}

TEST_F(MulRanFolder, IsRefusedWithNamesThatAreNoStamps) {
  scan("Ouster/first.bin", 0);
  EXPECT_THAT(refusal("slam.tum"), HasSubstr("first.bin: is not named by its stamp"));
}

TEST_F(MulRanFolder, IsRefusedWithTheTrajectoryOfAnotherDrive) {
  folder.write("other.tum", "5 0 0 0 0 0 0 1\n6 1 0 0 0 0 0 1\n");
  EXPECT_THAT(refusal("other.tum"), HasSubstr("has 3 frames, of which 0 lie within the time of"));
  EXPECT_THAT(refusal("slam.json"), HasSubstr("is neither .tum, .txt nor .csv"));
  EXPECT_THAT(refusal("none.tum"), HasSubstr("cannot be opened"));
}

TEST_F(MulRanFolder, IsRefusedWhenMissingOrEmpty) {
  EXPECT_THAT(refusal("slam.tum", {{"path", std::string("/no/such")}}),
              HasSubstr("there is no such folder"));
  fs::remove_all(path / "Ouster");
  EXPECT_THAT(refusal("slam.tum"), HasSubstr("has no frames"));
}

}  // namespace
}  // namespace plumb::source_mulran
