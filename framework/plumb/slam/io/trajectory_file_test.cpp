#include "plumb/slam/io/trajectory_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "plumb/data/io/file_testing.hpp"

namespace plumb {
namespace {

using io::refusal;
using io::TestFolder;
using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

Trajectory wandering(std::size_t count, double first_stamp, double step) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  Trajectory result;
  for (std::size_t k = 0; k < count; ++k) {
    result.stamps.push_back(first_stamp + step * static_cast<double>(k));
    result.T_world_frame.emplace_back(
        exp_rotation({normal(random), normal(random), normal(random)}),
        Eigen::Vector3d(100 * normal(random), -1000 * normal(random), normal(random)));
  }
  return result;
}

double apart(const Pose& a, const Pose& b) {
  const Pose d = a.inverse() * b;
  return d.translation.norm() + angle(d);
}

TEST(TrajectoryFile, GivesBackWhatWasWrittenAsTum) {
  const TestFolder folder;
  const auto truth = wandering(50, 1577836980.25, 0.1);
  const auto read = read_tum(folder.write("a.tum", tum_text(truth)));
  ASSERT_EQ(read.size(), truth.size());
  for (std::size_t k = 0; k < truth.size(); ++k) {
    EXPECT_NEAR(read.stamps[k], truth.stamps[k], 1e-6);
    EXPECT_LT(apart(read.T_world_frame[k], truth.T_world_frame[k]), 1e-8);
  }
  EXPECT_EQ(tum_text(read_tum(folder.write("b.tum", tum_text(read)))), tum_text(read));
}

TEST(TrajectoryFile, WritesStampsWithAsManyDecimalsAsTellThemApart) {
  Trajectory trajectory;
  trajectory.stamps = {0, 1e-7, 1};
  trajectory.T_world_frame.resize(3);
  const std::string zeros =
      " 0.000000000 0.000000000 0.000000000 0.000000000 0.000000000 0.000000000 1.000000000\n";
  EXPECT_EQ(tum_text(trajectory), "0.0000000" + zeros + "0.0000001" + zeros + "1.0000000" + zeros);
  trajectory.stamps[1] = 0.5;
  EXPECT_THAT(tum_text(trajectory), StartsWith("0.000000 "));
}

TEST(TrajectoryFile, ReadsTumWithCommentsAndNormalisesQuaternions) {
  const TestFolder folder;
  const auto read = read_tum(
      folder.write("a.tum", "# stamp x y z q\r\n\n 1.5\t1 2 3  0 0 0 2 # late\r\n2 0 0 0 3 0 0 4"));
  ASSERT_EQ(read.size(), 2u);
  EXPECT_EQ(read.stamps[0], 1.5);
  EXPECT_EQ(read.T_world_frame[0].translation, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(read.T_world_frame[0].rotation.w(), 1);
  EXPECT_DOUBLE_EQ(read.T_world_frame[1].rotation.x(), 0.6);
  EXPECT_DOUBLE_EQ(read.T_world_frame[1].rotation.w(), 0.8);
}

TEST(TrajectoryFile, ReadsKittiAndMulran) {
  const TestFolder folder;
  const auto truth = wandering(20, 100, 0.1);
  std::string times, csv;
  for (std::size_t k = 0; k < 20; ++k) times += std::to_string(truth.stamps[k]) + "\n";
  const auto read =
      read_kitti(folder.write("poses.txt", kitti_text(truth)), folder.write("times.txt", times));
  ASSERT_EQ(read.size(), 20u);
  for (std::size_t k = 0; k < 20; ++k) {
    EXPECT_NEAR(read.stamps[k], truth.stamps[k], 1e-6);
    EXPECT_LT(apart(read.T_world_frame[k], truth.T_world_frame[k]), 1e-7);
  }
  const auto mulran =
      read_mulran_csv(folder.write("global_pose.csv",
                                   "1564718964000000000,0,-1,0,5.5,1,0,0,6.5,0,0,1,7."
                                   "5\n1564718964500000000, 1,0,0,1, 0,1,0,2, 0,0,1,3\n"));
  ASSERT_EQ(mulran.size(), 2u);
  EXPECT_NEAR(mulran.stamps[1], 1564718964.5, 1e-6);
  EXPECT_EQ(mulran.T_world_frame[0].translation, Eigen::Vector3d(5.5, 6.5, 7.5));
  EXPECT_LT(
      (mulran.T_world_frame[0] * Eigen::Vector3d(1, 0, 0) - Eigen::Vector3d(5.5, 7.5, 7.5)).norm(),
      1e-12);
}

TEST(TrajectoryFile, RefusesWrongFilesWithTheLineAndTheCure) {
  const TestFolder folder;
  const auto said = [&](const std::string& text) {
    const auto file = folder.write("a.tum", text);
    const auto sentence = refusal([&] { read_tum(file); });
    EXPECT_THAT(sentence, StartsWith(file.string() + ":"));
    return sentence;
  };
  const std::string first = "1 0 0 0 0 0 0 1\n";
  EXPECT_THAT(said(first + "2 0 0 0 0 0 0 0\n"), AllOf(HasSubstr(":2:"), HasSubstr("norm 0")));
  EXPECT_THAT(said(first + "2 0 0 0 1e308 1e308 1e308 1e308\n"),
              AllOf(HasSubstr(":2:"), HasSubstr("the quaternion is too large")));
  EXPECT_THAT(said(first + "0.5 0 0 0 0 0 0 1\n"), AllOf(HasSubstr(":2:"), HasSubstr("not later")));
  EXPECT_THAT(said(first + first), HasSubstr("not later"));
  EXPECT_THAT(said(first + "2 1 1e300 0 0 0 0 1\n"),
              AllOf(HasSubstr(":2:"), HasSubstr("farther off")));
  EXPECT_EQ(
      read_tum(folder.write("back.tum", first + "0.5 0 0 0 0 0 0 1\n"), StampOrder::any).stamps,
      (std::vector<double>{1, 0.5}));
  EXPECT_THAT(said(first + "2 0 0 0 0 0 1\n"),
              AllOf(HasSubstr(":2:"), HasSubstr("7 numbers where 8")));
  EXPECT_THAT(said(first + "2 0 0 0 0 0 0 1 1\n"), HasSubstr("9 numbers where 8"));
  EXPECT_THAT(said(first + "2 0 0 zero 0 0 0 1\n"), HasSubstr("'zero' is not a finite number"));
  EXPECT_THAT(said(first + "2 nan 0 0 0 0 0 1\n"), HasSubstr("'nan'"));
  EXPECT_THAT(said(first + "2 1,5 0 0 0 0 0 1\n"), HasSubstr("'1,5'"));
  EXPECT_THAT(said("# nothing\n"), HasSubstr("no pose"));
  for (const auto& [text, kind] :
       {std::pair<std::string, std::string>{"ply\nformat ascii 1.0\n", "a point cloud (PLY)"},
        {"# .PCD v0.7\nVERSION 0.7\n", "a point cloud (PCD)"},
        {"1 0 0 0 0 1 0 0 0 0 1 0\n", "a trajectory (KITTI)"},
        {"# g\nVERTEX_SE2 0 0 0 0\n", "a pose graph (g2o)"},
        {"plumb: 1\n", "a pipeline"},
        {"{\"stages\": []}", "JSON"},
        {std::string("\x01\0\x02", 3), "binary data"}})
    EXPECT_THAT(said(text), AllOf(HasSubstr("is not a TUM trajectory, it looks like " + kind),
                                  HasSubstr("stamp tx ty tz")));
  EXPECT_THAT(refusal([&] { read_tum(folder.path() / "none.tum"); }), HasSubstr("No such file"));

  const auto poses = folder.write("poses.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n");
  const auto kitti = [&](const std::string& times) {
    return refusal([&] { read_kitti(poses, folder.write("times.txt", times)); });
  };
  EXPECT_THAT(kitti("1\n2\n"), HasSubstr("2 stamps for the 1 pose"));
  EXPECT_THAT(kitti("1\n0\n"), HasSubstr("not later"));
  const auto matrix = [&](const std::string& text) {
    return refusal([&] { read_mulran_csv(folder.write("a.csv", text)); });
  };
  EXPECT_THAT(matrix("1,1,0,0,0,0,1,0,0,0,0,1.1,0\n"), HasSubstr("not a rotation"));
  EXPECT_THAT(matrix("1,1,0,0,0,0,1,0,0,0,0,-1,0\n"), HasSubstr("not a rotation"));
  EXPECT_THAT(matrix(""), HasSubstr("no pose"));
}

TEST(PoseAt, LiesBetweenTheTwoPosesRoundTheStamp) {
  Trajectory trajectory;
  trajectory.stamps = {10, 12, 13};
  trajectory.T_world_frame = {Pose(), Pose(exp_rotation({0, 0, 1}), Eigen::Vector3d(4, 0, 0)),
                              Pose()};
  const Pose pose = pose_at(trajectory, 10.5, 0);
  EXPECT_LT(apart(pose, Pose(exp_rotation({0, 0, 0.25}), Eigen::Vector3d(1, 0, 0))), 1e-12);
  EXPECT_LT(apart(pose_at(trajectory, 12, 0), trajectory.T_world_frame[1]), 1e-12);
  EXPECT_LT(apart(pose_at(trajectory, 9.95, 0.1), trajectory.T_world_frame[0]), 1e-12);
  EXPECT_THAT(refusal([&] { pose_at(trajectory, 9.85, 0.1); }),
              HasSubstr("outside the trajectory"));
  EXPECT_THAT(refusal([&] { pose_at(trajectory, 13.2, 0.1); }), HasSubstr("13.200000"));
  EXPECT_THAT(refusal([&] { pose_at(trajectory, std::nan(""), 0.1); }), HasSubstr("outside"));
  EXPECT_THAT(refusal([&] { pose_at(Trajectory(), 1, 0.1); }), HasSubstr("empty"));
}

}  // namespace
}  // namespace plumb
