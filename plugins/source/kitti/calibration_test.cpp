#include "calibration.hpp"

#include <gmock/gmock.h>

#include <limits>

#include "plumb/slam/io/source_testing.hpp"

namespace plumb::source_kitti {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

/// Three frames; frame k has the points (k, 1, 2) and one that is no number. The camera looks along
/// the laser's x.
struct KittiFolder : testing::Test {
  io::TestFolder folder;
  const fs::path& path = folder.path();

  KittiFolder() {
    for (int k = 0; k < 3; ++k) {
      const float nan = std::numeric_limits<float>::quiet_NaN();
      const float points[8] = {static_cast<float>(k), 1, 2, 0.5f, nan, 0, 0, 0};
      folder.write("velodyne/00000" + std::to_string(k) + ".bin",
                   std::string(reinterpret_cast<const char*>(points), sizeof points));
    }
    folder.write("times.txt", "0\n1.0e-01\n0.2\n");
    // The camera goes 5 m along its z, which is forward.
    folder.write("poses.txt",
                 "1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 0 0 1 0 0 0 0 1 5\n1 0 0 0 0 1 0 0 0 0 1 10\n");
    folder.write("calib.txt",
                 "P0: 1 0 0 0 0 1 0 0 0 0 1 0\nTr: 0 -1 0 0.1 0 0 -1 -0.2 1 0 0 -0.3\n");
  }
  SourceResult run(ParameterValues values = {}) const {
    values.emplace("path", path.string());
    return read_source(values);
  }
  std::string refusal(const ParameterValues& values = {}) const {
    return io::refusal([&] {
      auto sequence = run(values);
      for (std::size_t k = 0; k < sequence.frames.keys.size(); ++k) sequence.frame(k);
    });
  }
};

TEST_F(KittiFolder, IsReadFrameByFrame) {
  auto sequence = run();
  ASSERT_EQ(sequence.frames.keys.size(), 3u);
  EXPECT_EQ(sequence.trajectory.stamps[1], 0.1);
  EXPECT_EQ(sequence.trajectory.T_world_frame[2].translation, Eigen::Vector3d(0, 0, 10));
  const Frame frame = sequence.frame(2);
  EXPECT_EQ(frame.index, 2u);
  ASSERT_EQ(frame.cloud.size(), 1u);
  EXPECT_EQ(frame.cloud.point(0), Eigen::Vector3f(2, 1, 2));
  EXPECT_EQ(frame.cloud.intensity[0], 0.5f);
  EXPECT_EQ(sequence.count("points with a non-finite coordinate dropped"), 1u);
}

TEST_F(KittiFolder, GivesTheLasersPosesWhereACalibrationIsNamed) {
  const auto sequence = run({{"calibration", (path / "calib.txt").string()}});
  const auto& poses = sequence.trajectory.T_world_frame;
  EXPECT_LT(poses[0].translation.norm() + angle(poses[0]), 1e-12);
  EXPECT_LT((poses[2].translation - Eigen::Vector3d(10, 0, 0)).norm(),
            1e-12);  // forward is the laser's x
}

TEST_F(KittiFolder, KeepsWhatTheCameraSawWhereItWas) {
  const Pose T_camera_laser = read_calibration(path / "calib.txt");
  const Pose T_world_camera(exp_rotation({0.1, -0.4, 0.2}), {3, 4, 5});
  Trajectory trajectory{{0}, {T_world_camera}};
  camera_to_laser(trajectory, T_camera_laser);
  const Eigen::Vector3d p(7, -2, 1);  // in the laser's frame
  const Eigen::Vector3d by_camera = T_world_camera * (T_camera_laser * p);
  EXPECT_LT((T_camera_laser * (trajectory.T_world_frame[0] * p) - by_camera).norm(), 1e-12);
}

TEST_F(KittiFolder, IsRefusedWhenAScanIsCutShort) {
  folder.write("velodyne/000001.bin", std::string(30, '\0'));
  EXPECT_THAT(refusal(), HasSubstr("000001.bin: has 30 bytes, which is not a multiple of 16"));
}

TEST_F(KittiFolder, IsRefusedWithoutFramesPosesOrTimes) {
  EXPECT_THAT(refusal({{"path", (path / "none").string()}}), HasSubstr("there is no such folder"));
  EXPECT_THAT(refusal({{"poses", (path / "none.txt").string()}}),
              HasSubstr("none.txt: cannot be opened"));
  fs::remove(path / "velodyne/000001.bin");
  EXPECT_THAT(refusal(),
              HasSubstr("has 2 frames, but " + (path / "poses.txt").string() + " has 3 poses"));
  fs::remove(path / "times.txt");
  EXPECT_THAT(refusal(), HasSubstr("times.txt: cannot be opened"));
  fs::remove_all(path / "velodyne");
  EXPECT_THAT(refusal(), HasSubstr("velodyne: there is no such folder"));
  fs::create_directories(path / "velodyne");
  EXPECT_THAT(refusal(), HasSubstr("has no frames"));
}

TEST_F(KittiFolder, IsRefusedWithACalibrationThatIsNone) {
  const ParameterValues values = {{"calibration", (path / "calib.txt").string()}};
  folder.write("calib.txt", "P0: 1 2 3\n");
  EXPECT_THAT(refusal(values), HasSubstr("calib.txt: has no line 'Tr:'"));
  folder.write("calib.txt", "\nTr: 1 0 0 0 0 1 0 0 0 0 1\n");
  EXPECT_THAT(refusal(values), HasSubstr("calib.txt:2: expected 12 numbers"));
  folder.write("calib.txt", "Tr: 2 0 0 0 0 2 0 0 0 0 2 0\n");
  EXPECT_THAT(refusal(values), HasSubstr("is not a rotation"));
}

}  // namespace
}  // namespace plumb::source_kitti
