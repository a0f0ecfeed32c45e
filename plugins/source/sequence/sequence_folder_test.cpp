#include "sequence_folder.hpp"

#include <gmock/gmock.h>

#include <limits>

#include "plumb/slam/io/cloud_file.hpp"
#include "plumb/slam/io/source_testing.hpp"

namespace plumb::source_sequence {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

/// Frame k has the points (k, 0, 0) and (k, 1, 0).
struct Folder : testing::Test {
  io::TestFolder folder;
  const fs::path& path = folder.path();

  Folder() { fs::create_directories(path / "frames"); }
  static Cloud cloud_of(int k) {
    Cloud cloud;
    cloud.add({static_cast<float>(k), 0, 0});
    cloud.add({static_cast<float>(k), 1, 0});
    return cloud;
  }
  void frames(int n) const {
    for (int k = 0; k < n; ++k)
      folder.write("frames/00" + std::to_string(k) + ".pcd", pcd_bytes(cloud_of(k)));
  }
  void odometry(int n, const std::string& name = "odometry.tum") const {
    std::string text;
    for (int k = 0; k < n; ++k)
      text += std::to_string(k) + ".5 " + std::to_string(10 * k) +
              " 0 0 0 0 0.70710678118654752 0.70710678118654752\n";
    folder.write(name, text);
  }

  SourceResult run(ParameterValues values = {}) const {
    values.emplace("path", path.string());
    return read_source(values);
  }
  std::string refusal(const ParameterValues& values = {}) const {
    return io::refusal([&] { run(values); });
  }
};

TEST_F(Folder, ReadsFramesInOrderOfTheirNames) {
  frames(3);
  odometry(3);
  auto sequence = run();
  ASSERT_EQ(sequence.frames.keys.size(), 3u);
  ASSERT_EQ(sequence.trajectory.size(), 3u);
  EXPECT_EQ(sequence.trajectory.stamps[2], 2.5);
  for (std::uint32_t k = 0; k < 3; ++k) {
    const Frame frame = sequence.frame(k);
    EXPECT_EQ(frame.index, k);
    ASSERT_EQ(frame.cloud.size(), 2u);
    EXPECT_EQ(frame.cloud.x[1], static_cast<float>(k));
  }
}

TEST_F(Folder, FollowsAListInItsOwnOrderAndOutOfTheFolder) {
  frames(3);
  odometry(2);
  folder.write("trip/frames.txt", "# back and out\n../frames/002.pcd\n\n  ../frames/000.pcd\r\n");
  auto sequence =
      run({{"path", (path / "trip").string()}, {"trajectory", (path / "odometry.tum").string()}});
  ASSERT_EQ(sequence.frames.keys.size(), 2u);
  EXPECT_EQ(sequence.frame(0).cloud.x[0], 2.0f);
  EXPECT_EQ(sequence.frame(1).cloud.x[0], 0.0f);
}

TEST_F(Folder, LeavesOutFramesWithTheirPosesWhenTold) {
  frames(6);
  odometry(6);
  auto late = run({{"skip_frames", std::int64_t{2}}});
  ASSERT_EQ(late.frames.keys.size(), 4u);
  EXPECT_EQ(late.trajectory.stamps[0], 2.5);
  const Frame first = late.frame(0);
  EXPECT_EQ(first.index, 0u);
  EXPECT_EQ(first.cloud.x[0], 2.0f);
  EXPECT_EQ(late.context.counts["frames left out as told"], 2u);
  auto thin = run({{"drop_frames", 0.5}, {"drop_seed", std::int64_t{7}}});
  EXPECT_EQ(thin.frames.keys.size(), 4u);  // 0, 2, 3 and 5
  ASSERT_EQ(thin.frames.keys.size(), thin.trajectory.size());
  for (std::size_t k = 0; k < thin.trajectory.size(); ++k)
    EXPECT_EQ(thin.frame(k).cloud.x[0], static_cast<float>(thin.trajectory.stamps[k] - 0.5));
  EXPECT_THAT(refusal({{"skip_frames", std::int64_t{5}}}), HasSubstr("leave 1"));
}

TEST_F(Folder, ReadsPlyFramesToo) {
  folder.write("frames/0.ply", ply_bytes(cloud_of(7)));
  folder.write("frames/1.ply", ply_bytes(cloud_of(8)));
  odometry(2);
  EXPECT_EQ(run().frame(1).cloud.x[0], 8.0f);
}

TEST_F(Folder, BringsWorldCloudsBackToTheirFrames) {
  frames(2);
  odometry(2);
  auto sequence = run({{"coordinates", std::string("world")}});
  // Frame 1 stands at (10, 0, 0), turned by 90 degrees: its x axis points along the world's y.
  const Frame frame = sequence.frame(1);
  EXPECT_NEAR(frame.cloud.x[1], 1, 1e-6);
  EXPECT_NEAR(frame.cloud.y[1], 9, 1e-6);
  const Pose& pose = sequence.trajectory.T_world_frame[1];
  EXPECT_LT((pose * frame.cloud.point(1).cast<double>() - Eigen::Vector3d(1, 1, 0)).norm(), 1e-6);
}

TEST_F(Folder, TurnsNormalsOfWorldCloudsWithoutMovingThem) {
  Cloud cloud = cloud_of(0);
  cloud.nx = {1, 0};
  cloud.ny = {0, 1};
  cloud.nz = {0, 0};
  bring_to_frame(cloud, Pose(exp_rotation({0, 0, M_PI / 2}), {5, 6, 7}));
  EXPECT_LT((cloud.normal(0) - Eigen::Vector3f(0, -1, 0)).norm(), 1e-6);
  EXPECT_LT((cloud.normal(1) - Eigen::Vector3f(1, 0, 0)).norm(), 1e-6);
}

TEST_F(Folder, CountsPointsThatAreNoNumbers) {
  frames(2);
  Cloud cloud = cloud_of(1);
  cloud.add({0, std::numeric_limits<float>::quiet_NaN(), 0});
  cloud.add({std::numeric_limits<float>::infinity(), 0, 0});
  folder.write("frames/001.pcd", pcd_bytes(cloud));
  odometry(2);
  auto sequence = run();
  EXPECT_EQ(sequence.frame(1).cloud.size(), 2u);
  EXPECT_EQ(sequence.count("points with a non-finite coordinate dropped"), 2u);
}

TEST_F(Folder, GivesAFrameAnotherKeyWhenItsFileOrItsUseChanges) {
  frames(3);
  odometry(3);
  const auto before = run().frames.keys;
  EXPECT_EQ(run().frames.keys, before);
  EXPECT_NE(before[0], before[1]);
  folder.write("frames/001.pcd", pcd_bytes(Cloud{.x = {1},
                                                 .y = {2},
                                                 .z = {3},
                                                 .intensity = {},
                                                 .time = {},
                                                 .ring = {},
                                                 .nx = {},
                                                 .ny = {},
                                                 .nz = {}}));
  const auto after = run().frames.keys;
  EXPECT_EQ(after[0], before[0]);
  EXPECT_NE(after[1], before[1]);
  EXPECT_NE(run({{"coordinates", std::string("world")}}).frames.keys[0], before[0]);
}

TEST_F(Folder, IsRefusedWhenItIsMissingOrEmpty) {
  odometry(2);
  EXPECT_THAT(refusal({{"path", std::string("/no/such/folder")}}),
              HasSubstr("/no/such/folder: there is no such folder"));
  EXPECT_THAT(refusal({{"path", (path / "odometry.tum").string()}}),
              HasSubstr("is not a directory"));
  EXPECT_THAT(refusal(), HasSubstr("has no frames"));
  folder.write("frames.txt", "# nothing\n");
  EXPECT_THAT(refusal(), HasSubstr("lists no frame"));
}

TEST_F(Folder, IsRefusedWithoutOdometryOrWithAnotherNumberOfPoses) {
  frames(3);
  EXPECT_THAT(refusal(), HasSubstr("odometry.tum: cannot be opened"));
  odometry(2);
  EXPECT_THAT(refusal(),
              HasSubstr("has 3 frames, but " + (path / "odometry.tum").string() + " has 2 poses"));
  odometry(4);
  EXPECT_THAT(refusal(), HasSubstr("has 4 poses"));
}

TEST_F(Folder, IsRefusedWithASingleFrame) {
  frames(1);
  odometry(1);
  EXPECT_THAT(refusal(), HasSubstr("has 1 frame, but needs at least 2"));
}

TEST_F(Folder, IsRefusedWhenAListedFrameIsMissing) {
  frames(1);
  odometry(2);
  folder.write("frames.txt", "frames/000.pcd\nframes/009.pcd\n");
  EXPECT_THAT(refusal(), HasSubstr("frames.txt:2: frame 'frames/009.pcd' is missing"));
  folder.write("frames.txt", "frames/000.pcd\nframes/000.pcd\nframes\n");
  EXPECT_THAT(refusal(), HasSubstr("frames.txt:3: frame 'frames' is a folder, not a regular file"));
}

}  // namespace
}  // namespace plumb::source_sequence
