#include "simulate/simulate.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "plumb/slam/geometry/search_tree.hpp"
#include "plumb/slam/io/cloud_file.hpp"
#include "plumb/slam/io/trajectory_file.hpp"
#include "simulate/drift.hpp"
#include "simulate/testing.hpp"

namespace plumb::simulate {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

TEST(Simulate, PointsUnderTheTruthLieOnTheWorldWithinTheNoise) {
  const Stage stage = set_up(small_scene("blocks", 40, 300));
  for (std::size_t k = 0; k < stage.truth.size(); k += 13) {
    const Pose& pose = stage.truth.T_world_frame[k];
    const Cloud cloud = stage.frame(k);
    ASSERT_GT(cloud.size(), 1000u);
    double sum = 0;
    for (std::size_t n = 0; n < cloud.size(); ++n) {
      const Eigen::Vector3f point =
          (pose * cloud.point(n).cast<double>() - stage.world.origin()).cast<float>();
      Ray ray;
      ray.origin = (pose.translation - stage.world.origin()).cast<float>();
      ray.direction = (point - ray.origin).normalized();
      // At an edge a direction that is off in its last digit may meet the one or the other side:
      // look to both.
      float error = 1;
      for (const float turn : {0.0f, 1e-5f, -1e-5f}) {
        Ray beside = ray;
        beside.direction =
            (ray.direction + turn * Eigen::Vector3f(ray.direction.y(), -ray.direction.x(), 1))
                .normalized();
        const float distance = stage.world.cast_by_brute_force(beside, 120).t;
        error = std::min(error, std::abs(distance - (point - ray.origin).norm()));
      }
      EXPECT_LT(error, 3.5f * 0.02f + 0.005f);
      sum += static_cast<double>(error * error);
    }
    EXPECT_NEAR(std::sqrt(sum / static_cast<double>(cloud.size())), 0.02, 0.003);
  }
}

TEST(Simulate, TheSameSeedGivesTheSameBytesOnOneAndOnTwoThreads) {
  const TestFolder one, two, other;
  Scene scene = small_scene("city_loop", 12, 30);
  simulate(scene, one.path(), 1);
  simulate(scene, two.path(), 2);
  EXPECT_EQ(files(one.path()), files(two.path()));
  EXPECT_EQ(files(one.path()).size(), 15u);
  scene.seed = 2;
  simulate(scene, other.path(), 2);
  EXPECT_NE(contents(one.path() / "frames/000003.pcd"),
            contents(other.path() / "frames/000003.pcd"));
  EXPECT_NE(contents(one.path() / "odometry.tum"), contents(other.path() / "odometry.tum"));
}

TEST(Simulate, TheSceneThatItLeavesRepeatsIt) {
  const TestFolder first, again;
  simulate(small_scene("out_and_back", 5, 33.3), first.path());
  simulate(read_scene(first.path() / "scene.yaml"), again.path());
  EXPECT_EQ(files(first.path()), files(again.path()));
}

TEST(Simulate, WritesWhatTheReadersRead) {
  const TestFolder folder;
  const Scene scene = small_scene("figure_eight", 6, 40);
  const Summary made = simulate(scene, folder.path());
  const Stage stage = set_up(scene);
  const Cloud read = read_pcd(folder.path() / "frames/000005.pcd").cloud, expected = stage.frame(5);
  EXPECT_EQ(read.x, expected.x);
  EXPECT_EQ(read.z, expected.z);
  EXPECT_EQ(read.intensity, expected.intensity);
  const Trajectory truth = read_tum(folder.path() / "truth.tum"),
                   odometry = read_tum(folder.path() / "odometry.tum");
  EXPECT_EQ(truth.stamps, odometry.stamps);
  EXPECT_NEAR(
      (truth.T_world_frame[5].translation - stage.truth.T_world_frame[5].translation).norm(), 0,
      1e-8);
  EXPECT_EQ(made.frames, 6u);
  EXPECT_NEAR(drift_of(odometry, truth), made.drift, 1e-6);
}

TEST(Simulate, ARevisitedStreetLooksTheSameFromBothDirections) {
  Scene scene = small_scene("out_and_back", 201, 400);
  scene.lines = 64;
  scene.columns = 1024;
  const Stage stage = set_up(scene);
  const Pose& out = stage.truth.T_world_frame[40];
  std::size_t back = 0;
  double nearest = 1e9;
  for (std::size_t k = 110; k < stage.truth.size(); ++k) {
    const double d = (stage.truth.T_world_frame[k].translation - out.translation).norm();
    if (d < nearest) nearest = d, back = k;
  }
  ASSERT_LT(nearest, 5);
  ASSERT_GT(angle(out.inverse() * stage.truth.T_world_frame[back]), 2.5);
  const auto placed = [&](std::size_t k) {
    std::vector<Eigen::Vector3f> points;
    const Cloud cloud = stage.frame(k);
    for (std::size_t n = 0; n < cloud.size(); ++n)
      if (const Eigen::Vector3f p = cloud.point(n); p.norm() < 15 && p.z() > -1)
        points.push_back(
            (stage.truth.T_world_frame[k] * p.cast<double>() - out.translation).cast<float>());
    return points;
  };
  const auto a = placed(40), b = placed(back);
  std::vector<float> gaps;
  for (std::size_t n = 0; n < b.size(); n += 50) {
    float gap = 1e9f;
    for (const auto& p : a) gap = std::min(gap, (p - b[n]).squaredNorm());
    gaps.push_back(std::sqrt(gap));
  }
  ASSERT_GT(gaps.size(), 100u);
  std::sort(gaps.begin(), gaps.end());
  EXPECT_LT(gaps[gaps.size() / 2], 0.12f);
}

TEST(Simulate, FollowsAFileOfPosesFarFromZero) {
  const TestFolder folder;
  Trajectory path = set_up(small_scene("city_loop", 20, 40)).truth;
  for (Pose& pose : path.T_world_frame) pose.translation += Eigen::Vector3d(400000, 5000000, 120);
  folder.write("path.tum", tum_text(path));
  Scene scene = small_scene("", 10, 0);
  scene.length.reset();
  scene.path = (folder.path() / "path.tum").string();
  scene.drift = 0.5;
  const Stage stage = set_up(scene);
  EXPECT_EQ(stage.truth.size(), 10u);
  EXPECT_NEAR(drift_of(stage.odometry, stage.truth), 0.5, 1e-3);
  const Cloud cloud = stage.frame(9);
  EXPECT_GT(cloud.size(), 1000u);
  double lowest = 0;
  for (std::size_t k = 0; k < cloud.size(); ++k)
    if (std::hypot(cloud.x[k], cloud.y[k]) < 8)
      lowest = std::min(lowest, static_cast<double>(cloud.z[k]));
  EXPECT_NEAR(lowest, -1.73, 0.5);  // the land slopes
  scene.frames = 21;
  EXPECT_THAT(refusal([&] { set_up(scene); }), HasSubstr("has 20 poses and 21 frames are asked"));
}

/// Share of the rays of a scan at frame `a` that read the same, to 5 cm, at frame `b`.
double share_alike(const Scene& scene, std::size_t a, std::size_t b) {
  const Stage stage = set_up(scene);
  const Cloud first = stage.frame(a), second = stage.frame(b);
  const SearchTree tree(second);
  std::size_t same = 0;
  for (std::size_t k = 0; k < first.size(); ++k) {
    SearchTree::Neighbour nearest;
    same += tree.nearest_within(first.point(k), 0.05f, nearest);
  }
  return static_cast<double>(same) / static_cast<double>(first.size());
}

TEST(Simulate, StreetsThatAreAlikeRepeatThemselves) {
  // A straight way of 240 m, a pose a metre; frames 100 and 160 lie one block apart.
  const TestFolder folder;
  std::string poses;
  for (int k = 0; k < 240; ++k)
    poses += std::to_string(0.1 * k) + " " + std::to_string(k) + " 0 0 0 0 0 1\n";
  Scene scene;
  folder.write("way.tum", poses);
  scene.path = (folder.path() / "way.tum").string();
  scene.lines = 16, scene.columns = 256, scene.range = 25, scene.noise = 0, scene.drift = 0;
  const double different = share_alike(scene, 100, 160);
  scene.alike = 20;
  EXPECT_THAT(refusal([&] { set_up(scene); }), HasSubstr("blocks of less than 40 m"));
  scene.alike = 60;
  EXPECT_GT(share_alike(scene, 100, 160), 0.8);
  EXPECT_LT(share_alike(scene, 100, 130), 0.6);
  EXPECT_LT(different, 0.6);
}

TEST(Simulate, ReplacesItsOwnFolderAndNoOther) {
  const TestFolder folder;
  const Scene scene = small_scene("city_loop", 3, 10);
  const fs::path place = folder.path() / "deep" / "sequence";
  simulate(scene, place);
  simulate(scene, place.string() + "/");
  EXPECT_EQ(files(place).size(), 6u);
  folder.write("deep/sequence/notes.txt", "mine");
  EXPECT_THAT(refusal([&] { simulate(scene, place); }), HasSubstr("name another folder"));
  EXPECT_EQ(contents(place / "notes.txt"), "mine");
  folder.write("file", "mine");
  EXPECT_THAT(refusal([&] { simulate(scene, folder.path() / "file"); }), HasSubstr("is a file"));
}

TEST(Simulate, LeavesNothingBehindWhenItRefuses) {
  const TestFolder folder;
  Scene scene = small_scene("city_loop", 3, 10);
  scene.path = "nowhere.tum";
  scene.length.reset();
  EXPECT_THAT(refusal([&] { simulate(scene, folder.path() / "sequence"); }),
              HasSubstr("nowhere.tum"));
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

TEST(Simulate, ReportsEveryFrame) {
  const TestFolder folder;
  std::vector<std::size_t> told;
  simulate(small_scene("city_loop", 7, 10), folder.path(), 2,
           [&](std::size_t done, std::size_t) { told.push_back(done); });
  EXPECT_THAT(told, testing::ElementsAre(1, 2, 3, 4, 5, 6, 7));
}

}  // namespace
}  // namespace plumb::simulate
