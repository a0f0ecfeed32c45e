#include "plumb/slam/report/alike.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <random>

#include "plumb/data/io/file_testing.hpp"
#include "plumb/slam/io/cloud_file.hpp"
#include "plumb/slam/io/trajectory_file.hpp"
#include "plumb/slam/trajectory_error.hpp"

namespace plumb {
namespace {

using experiment::Cell;
using io::TestFolder;

/// Out along x for 20 frames 2 m apart and back on the same road. `drift`: from frame to frame so
/// much [dm] farther along x, [0.01 rad] more to the left, and on the way back so much [m] too
/// high.
Trajectory trip(double drift) {
  Trajectory made;
  for (int k = 0; k < 40; ++k) {
    const bool back = k >= 20;
    made.stamps.push_back(0.5 * k);
    made.T_world_frame.emplace_back(exp_rotation({0, 0, (back ? 3.0 : 0.0) + 0.01 * drift * k}),
                                    Eigen::Vector3d(2.0 * (back ? 39 - k : k) + 0.1 * drift * k,
                                                    back ? 1 : 0, back ? drift : 0));
  }
  return made;
}

Trajectory without(Trajectory trajectory, std::size_t first, std::size_t end) {
  const auto cut = [&](auto& list) {
    list.erase(list.begin() + static_cast<std::ptrdiff_t>(first),
               list.begin() + static_cast<std::ptrdiff_t>(end));
  };
  cut(trajectory.stamps), cut(trajectory.T_world_frame);
  return trajectory;
}

/// A run's numbers as measure.trajectory would have them.
Cell cell_of(const Trajectory& estimate, const Trajectory& truth) {
  const PosePairs pairs = pair_by_stamp(estimate, truth);
  const auto relative = relative_error(pairs);
  Cell cell;
  cell.figures = {{{"error.fine.ate", absolute_error(pairs).rmse, "m"}},
                  {{"error.fine.rpe_translation", relative.translation, "m"}},
                  {{"error.fine.rpe_rotation", relative.rotation, "rad"}},
                  {{"error.fine.displacement_x", 1, "m"}},
                  {{"map_error.mean", 2, "m"}}};
  return cell;
}

struct Beside : testing::Test {
  TestFolder folder;
  std::filesystem::path truth = folder.write("truth.tum", tum_text(trip(0)));

  WrittenTrajectory written(const Trajectory& trajectory) const {
    WrittenTrajectory made;
    made.trajectory = trajectory;
    made.prefix = "error.fine.";
    made.truth = truth;
    return made;
  }
};

TEST_F(Beside, ErrorsAreKnownByTwentyPartsOfTheTruePath) {
  const Trajectory bent = trip(0.3);
  Cell cell = cell_of(bent, trip(0));
  const Cell before = cell;
  std::vector<RunBeside> runs{{&cell, written(bent)}};
  EXPECT_EQ(judge_at_same_stamps(runs), 0u);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(cell.figures[k].segments.size(), 20u) << k;
    EXPECT_EQ(cell.figures[k].number.value, before.figures[k].number.value);
    EXPECT_NEAR(cell.figures[k].segments.value(), cell.figures[k].number.value, 1e-7);
  }
  EXPECT_TRUE(cell.figures[0].segments.root);
  EXPECT_EQ(cell.figures[3].segments.size(), 0u);
  EXPECT_EQ(cell.figures.size(), before.figures.size());
}

TEST_F(Beside, ErrorsAreOfTheStampsThatAllVariantsHave) {
  const Trajectory whole = trip(0.3), part = without(trip(0.3), 25, 40);
  Cell of_whole = cell_of(whole, trip(0)), of_part = cell_of(part, trip(0));
  ASSERT_GT(std::abs(of_whole.figures[0].number.value - of_part.figures[0].number.value), 0.005);
  std::vector<RunBeside> runs{{&of_whole, written(whole)}, {&of_part, written(part)}};
  EXPECT_EQ(judge_at_same_stamps(runs), 15u);
  for (const char* name :
       {"error.fine.ate", "error.fine.rpe_translation", "error.fine.rpe_rotation"}) {
    ASSERT_TRUE(of_whole.find(name) && of_part.find(name));
    EXPECT_NEAR(of_whole.find(name)->number.value, of_part.find(name)->number.value, 1e-6) << name;
  }
  EXPECT_FALSE(of_whole.find("error.fine.displacement_x")) << "it stands for other stamps";
  EXPECT_FALSE(of_part.find("error.fine.displacement_x")) << "so that no variant alone has it";
  EXPECT_TRUE(of_whole.find("map_error.mean"));
}

TEST_F(Beside, AnErrorThatTheCommonStampsDoNotGiveIsNone) {
  const Trajectory whole = trip(0.3), part = without(trip(0.3), 4, 40);  // 6 m, and no 10 m
  Cell of_whole = cell_of(whole, trip(0)), of_part = cell_of(part, trip(0));
  std::erase_if(of_part.figures, [](const auto& f) { return std::isnan(f.number.value); });
  std::vector<RunBeside> runs{{&of_whole, written(whole)}, {&of_part, written(part)}};
  EXPECT_EQ(judge_at_same_stamps(runs), 36u);
  EXPECT_TRUE(of_whole.find("error.fine.ate"));
  EXPECT_FALSE(of_whole.find("error.fine.rpe_translation"));
  EXPECT_FALSE(of_part.find("error.fine.rpe_translation"));
}

TEST_F(Beside, ARunThatFailedOrWroteNoTrajectoryIsLeftAlone) {
  Cell failed, other = cell_of(trip(0.1), trip(0));
  std::vector<RunBeside> runs{{&failed, std::nullopt}, {&other, std::nullopt}};
  EXPECT_EQ(judge_at_same_stamps(runs), 0u);
  add_sharpness(runs);
  EXPECT_TRUE(failed.figures.empty());
  EXPECT_EQ(other.figures[0].segments.size(), 0u);
}

TEST_F(Beside, SharpnessTellsTheBetterTrajectoryWithoutATruth) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> along(-10, 50), across(-8, 8), up(0, 3);
  std::vector<Eigen::Vector3d> world;
  for (int k = 0; k < 1200; ++k) world.emplace_back(along(random), across(random), up(random));
  const Trajectory right = trip(0), wrong = trip(0.5);
  for (std::size_t k = 0; k < right.size(); ++k) {
    Cloud cloud;
    const Pose T_frame_world = right.T_world_frame[k].inverse();
    for (const auto& p : world)
      if ((T_frame_world * p).norm() < 12) cloud.add((T_frame_world * p).cast<float>());
    folder.write("frames/" + std::to_string(100 + k) + ".pcd", pcd_bytes(cloud));
  }
  folder.write("odometry.tum", tum_text(wrong));
  const auto with_frames = [&](const Trajectory& trajectory) {
    WrittenTrajectory made;
    made.trajectory = trajectory;
    made.frames = folder.path();
    made.odometry = folder.path() / "odometry.tum";
    return made;
  };
  Cell of_right, of_wrong, of_part;
  std::vector<RunBeside> runs{{&of_wrong, with_frames(wrong)},
                              {&of_right, with_frames(right)},
                              {&of_part, with_frames(without(right, 0, 3))}};
  add_sharpness(runs);
  ASSERT_TRUE(of_right.find("sharpness") && of_wrong.find("sharpness") &&
              of_part.find("sharpness"));
  EXPECT_LT(of_right.find("sharpness")->number.value, 0.01);
  EXPECT_GT(of_wrong.find("sharpness")->number.value, 0.1);
  EXPECT_EQ(of_right.find("sharpness")->number.value, of_part.find("sharpness")->number.value);
  EXPECT_EQ(of_right.find("sharpness")->number.unit, "m");
}

TEST_F(Beside, SharpnessIsLeftOutWhereFramesAreNotInFiles) {
  Cell cell;
  WrittenTrajectory made;
  made.trajectory = trip(0);
  made.frames = folder.path() / "nowhere";
  made.odometry = folder.path() / "nowhere/odometry.tum";
  std::vector<RunBeside> runs{{&cell, made}};
  add_sharpness(runs);
  EXPECT_TRUE(cell.figures.empty());
}

}  // namespace
}  // namespace plumb
