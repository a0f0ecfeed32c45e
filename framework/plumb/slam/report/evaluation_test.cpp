#include "plumb/slam/report/evaluation.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <random>

#include "plumb/data/io/file_testing.hpp"
#include "plumb/slam/io/cloud_file.hpp"
#include "plumb/slam/io/trajectory_file.hpp"

namespace plumb {
namespace {

using io::refusal;
using io::TestFolder;
using testing::AllOf;
using testing::HasSubstr;

/// Out along x for 20 frames 2 m apart and back on the same road, turned round. Estimate: the way
/// back is `lift` [m] too high.
struct Trip {
  Trajectory truth, lifted;
  explicit Trip(double lift) {
    for (int k = 0; k < 40; ++k) {
      const bool back = k >= 20;
      const double x = 2.0 * (back ? 39 - k : k);
      const Pose pose(exp_rotation({0, 0, back ? 3.0 : 0.0}), Eigen::Vector3d(x, back ? 1 : 0, 0));
      truth.stamps.push_back(0.5 * k);
      truth.T_world_frame.push_back(pose);
      lifted.T_world_frame.push_back(pose);
      if (back) lifted.T_world_frame.back().translation.z() += lift;
    }
    lifted.stamps = truth.stamps;
  }
};

/// Writes the trip as a sequence: every frame sees the world's points within 12 m, in coordinates
/// of its own.
std::vector<Cloud> write_sequence(const TestFolder& folder, const Trip& trip) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> along(-10, 50), across(-8, 8), up(0, 3);
  std::vector<Eigen::Vector3d> world;
  for (int k = 0; k < 1200; ++k) world.emplace_back(along(random), across(random), up(random));
  std::vector<Cloud> clouds;
  for (std::size_t k = 0; k < trip.truth.size(); ++k) {
    Cloud cloud;
    const Pose T_frame_world = trip.truth.T_world_frame[k].inverse();
    for (const auto& p : world)
      if ((T_frame_world * p).norm() < 12) cloud.add((T_frame_world * p).cast<float>());
    folder.write("frames/" + std::to_string(100 + k) + ".pcd", pcd_bytes(cloud));
    clouds.push_back(std::move(cloud));
  }
  folder.write("truth.tum", tum_text(trip.truth));
  folder.write("odometry.tum", tum_text(trip.lifted));
  folder.write("straight.tum", tum_text(trip.truth));
  return clouds;
}

double ghosting_by_brute_force(const std::vector<Cloud>& clouds, const std::vector<Pose>& poses,
                               const std::vector<Revisit>& revisits) {
  std::vector<double> gaps;
  for (const auto& [i, j] : revisits) {
    const Pose T = poses[j].inverse() * poses[i];
    std::vector<double> d;
    for (std::size_t k = 0; k < clouds[i].size(); ++k) {
      double least = 1e9;
      for (std::size_t m = 0; m < clouds[j].size(); ++m)
        least = std::min(
            least,
            (T * clouds[i].point(k).cast<double>() - clouds[j].point(m).cast<double>()).norm());
      d.push_back(least);
    }
    std::sort(d.begin(), d.end());
    const double place = 0.8 * static_cast<double>(d.size() - 1), whole = std::floor(place);
    const auto at = static_cast<std::size_t>(whole);
    const double limit = d[at] + (place - whole) * (d[at + 1] - d[at]);
    double sum = 0, count = 0;
    for (const double each : d)
      if (each < limit) sum += each * each, ++count;
    gaps.push_back(std::sqrt(sum / count));
  }
  std::sort(gaps.begin(), gaps.end());
  const std::size_t n = gaps.size();
  return 0.5 * (gaps[(n - 1) / 2] + gaps[n / 2]);
}

TEST(Evaluation, OfALiftedWayBackIsTheOneReckonedByHandAndByBruteForce) {
  const Trip trip(0.05);
  const TestFolder folder;
  const auto clouds = write_sequence(folder, trip);
  const Evaluation result = evaluate({folder.path(), folder.path() / "straight.tum", {}, true});
  EXPECT_EQ(result.true_poses, 40u);
  EXPECT_EQ(result.after.poses, 40u);
  EXPECT_LT(result.after.absolute.max, 1e-8);
  ASSERT_TRUE(result.before && result.before->ghosting && result.after.ghosting);

  // The way out lies 19 frames back at the most, so pairs need a quarter of the path of 77 m: 19 m.
  const auto revisits = revisits_of(trip.truth.T_world_frame);
  ASSERT_FALSE(revisits.empty());
  EXPECT_EQ(revisits[0].first, 0u);
  EXPECT_EQ(revisits[0].second, 39u);
  EXPECT_EQ(result.before->ghosting->pairs, revisits.size());
  const auto brute = [&](const Trajectory& t) {
    return ghosting_by_brute_force(clouds, t.T_world_frame, revisits);
  };
  EXPECT_NEAR(result.before->ghosting->estimate, brute(trip.lifted), 1e-7);
  EXPECT_NEAR(result.before->ghosting->truth, brute(trip.truth), 1e-7);
  EXPECT_NEAR(result.before->ghosting->estimate, 0.05, 1e-3)
      << "all points of the way back are 5 cm too high";
  EXPECT_LT(result.after.ghosting->estimate, 1e-5);

  // Of the 35 or so pairs of poses 10 m apart, the lift lies between those of 5.
  EXPECT_NEAR(result.before->relative.translation, 0.05 * 5 / 35, 2e-3);
  EXPECT_GT(result.before->absolute.max, 1e-4);  // the alignment's roll takes most of it away
  EXPECT_LT(result.before->absolute.max, 0.05);
}

TEST(Evaluation, FollowsTheListOfFramesAndGoesWithoutOdometry) {
  const Trip trip(0.05);
  const TestFolder folder;
  write_sequence(folder, trip);
  const auto straight = folder.path() / "straight.tum";
  const auto direct = evaluate({folder.path(), straight, {}, true});
  std::string list;
  for (int k = 0; k < 40; ++k) list += "  ../frames/" + std::to_string(100 + k) + ".pcd \n";
  folder.write("listed/frames.txt", list);
  const auto listed =
      evaluate({folder.path() / "listed", straight, folder.path() / "truth.tum", true});
  EXPECT_FALSE(listed.before.has_value());
  EXPECT_EQ(listed.after.ghosting->estimate, direct.after.ghosting->estimate);
  EXPECT_THAT(evaluation_table(listed), AllOf(HasSubstr("after"), Not(HasSubstr("before"))));
}

TEST(Evaluation, WritesJsonWithNullForWhatIsNoNumber) {
  const TestFolder folder;
  folder.write("truth.tum", "0 0 0 0 0 0 0 1\n1 1 0 0 0 0 0 1\n2 2 0 0 0 0 0 1\n");
  const auto some = folder.write("some.tum", "0 0 0 0 0 0 0 1\n1 1 0 0 0 0 0 1\n");
  const auto json =
      nlohmann::json::parse(evaluation_json(evaluate({folder.path(), some, {}, false})));
  EXPECT_EQ(json["after"]["poses"], 2);
  EXPECT_TRUE(json["after"]["rpe_m"].is_null());
  EXPECT_FALSE(json["after"].contains("ghosting"));
  EXPECT_FALSE(json.contains("before"));
}

TEST(Evaluation, RefusesWrongInputsWithASentence) {
  const TestFolder folder;
  const auto said = [&](bool clouds = false) {
    return refusal([&] { evaluate({folder.path(), folder.path() / "a.tum", {}, clouds}); });
  };
  EXPECT_THAT(refusal([&] {
                evaluate({folder.path() / "none", "a.tum", {}, false});
              }),
              HasSubstr("none"));
  EXPECT_THAT(said(), AllOf(HasSubstr("no truth.tum"), HasSubstr("--truth")));
  folder.write("truth.tum", "0 0 0 0 0 0 0 1\n1 1 0 0 0 0 0 1\n");
  EXPECT_THAT(said(), AllOf(HasSubstr("a.tum"), HasSubstr("No such file")));
  folder.write("a.tum", "ply\nformat binary_little_endian 1.0\n");
  EXPECT_THAT(
      said(),
      HasSubstr(
          "a.tum: is not a TUM trajectory, it looks like a point cloud (PLY): give a text file"));
  folder.write("a.tum", "100 0 0 0 0 0 0 1\n");
  EXPECT_THAT(said(), AllOf(HasSubstr("a.tum"), HasSubstr("none of its stamps")));
  folder.write("frames/0.pcd", pcd_bytes({}));
  folder.write("a.tum", "0 0 0 0 0 0 0 1\n1 1 0 0 0 0 0 1\n");
  EXPECT_THAT(said(true), HasSubstr("1 frame for 2 true poses"));
  folder.write("frames.txt", "frames/0.pcd\nframes/1.pcd\n");
  EXPECT_THAT(said(true), HasSubstr("frames.txt:2: frame 'frames/1.pcd' is missing"));
}

TEST(Ghosting, QuantilesLieLinearlyBetweenNeighbours) {
  EXPECT_DOUBLE_EQ(quantile({4, 1, 3, 2}, 0.5), 2.5);
  EXPECT_DOUBLE_EQ(quantile({0, 10}, 0.8), 8);
  EXPECT_DOUBLE_EQ(quantile({5, 1, 2, 3, 4, 0}, 0.8), 4);
  EXPECT_DOUBLE_EQ(quantile({7}, 0.8), 7);
  EXPECT_TRUE(std::isnan(quantile({}, 0.8)));
}

}  // namespace
}  // namespace plumb
