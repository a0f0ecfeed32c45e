#include "simulate/indoor.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <sstream>

#include "plumb/slam/io/trajectory_file.hpp"
#include "simulate/testing.hpp"

namespace plumb::simulate {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

/// Quick: few scans of few beams.
IndoorScene small(const std::string& path) {
  IndoorScene scene;
  scene.path = path;
  scene.length = 14;
  scene.rate = 1;
  scene.columns = 61;
  return scene;
}

std::vector<std::string> words(const std::string& line) {
  std::istringstream in(line);
  return {std::istream_iterator<std::string>(in), {}};
}

/// The fields of every line of the log that begins with `kind`.
std::vector<std::vector<std::string>> lines_of(const fs::path& log, const std::string& kind) {
  std::istringstream in(contents(log));
  std::vector<std::vector<std::string>> found;
  for (std::string line; std::getline(in, line);)
    if (line.starts_with(kind + " ")) found.push_back(words(line));
  return found;
}

TEST(Indoor, TheSameSeedGivesTheSameBytesOnOneAndOnTwoThreads) {
  for (const std::string& name : indoor_names()) {
    const TestFolder one, two, other;
    IndoorScene scene = small(name);
    simulate(scene, one.path(), 1);
    simulate(scene, two.path(), 2);
    EXPECT_EQ(files(one.path()), files(two.path()));
    EXPECT_EQ(files(one.path()).size(), 5u);
    scene.seed = 2;
    simulate(scene, other.path(), 2);
    for (const char* file : {"log.clf", "odometry.tum", "plan.txt"})
      EXPECT_NE(contents(one.path() / file), contents(other.path() / file)) << name << file;
  }
}

TEST(Indoor, TheSceneThatItLeavesRepeatsIt) {
  const TestFolder first, again;
  IndoorScene scene = small("lookalike");
  scene.kidnap = 2;
  scene.drop_in_turns = 1.0 / 3;
  scene.field_of_view = 2;
  simulate(scene, first.path());
  ASSERT_TRUE(is_indoor_scene(first.path() / "scene.yaml"));
  simulate(read_indoor_scene(first.path() / "scene.yaml"), again.path());
  EXPECT_EQ(files(first.path()), files(again.path()));
}

TEST(Indoor, EveryScanOfTheLogHasItsTruthAndItsOdometryUnderItsStamp) {
  const TestFolder folder;
  IndoorScene scene = small("rooms");
  scene.kidnap = 1;
  const IndoorSummary made = simulate(scene, folder.path());
  const auto scans = lines_of(folder.path() / "log.clf", "ROBOTLASER1");
  const Trajectory truth = read_tum(folder.path() / "truth.tum"),
                   odometry = read_tum(folder.path() / "odometry.tum");
  ASSERT_EQ(scans.size(), made.scans);
  ASSERT_EQ(truth.size(), scans.size());
  EXPECT_EQ(truth.stamps, odometry.stamps);
  EXPECT_EQ(lines_of(folder.path() / "log.clf", "ODOM").size(), made.scans + made.lost);
  EXPECT_GE(made.lost, 8u);
  for (std::size_t k = 0; k < scans.size(); ++k) {
    const std::vector<std::string>& words = scans[k];
    ASSERT_EQ(words.size(), 9u + 61 + 1 + 6 + 5 + 3);
    EXPECT_EQ(std::stod(words[words.size() - 3]), truth.stamps[k]);
    const std::size_t pose = 9 + 61 + 1;
    EXPECT_NEAR(std::stod(words[pose]), odometry.T_world_frame[k].translation.x(), 1e-6);
    EXPECT_NEAR(std::stod(words[pose + 1]), odometry.T_world_frame[k].translation.y(), 1e-6);
    const double heading = std::stod(words[pose + 2]);
    EXPECT_NEAR(
        std::abs(planar::wrapped(heading - log_rotation(odometry.T_world_frame[k].rotation).z())),
        0, 1e-6);
  }
  EXPECT_TRUE(truth.T_world_frame[0].translation.isApprox(odometry.T_world_frame[0].translation));
}

TEST(Indoor, ScansUnderTheTruthLieOnTheWallsOfThePlan) {
  const TestFolder folder;
  IndoorScene scene = small("corridor");
  simulate(scene, folder.path());
  std::vector<Wall> walls;
  std::istringstream plan(contents(folder.path() / "plan.txt"));
  for (Wall wall; plan >> wall.a.x() >> wall.a.y() >> wall.b.x() >> wall.b.y();)
    walls.push_back(wall);
  EXPECT_GT(walls.size(), 30u);
  const Trajectory truth = read_tum(folder.path() / "truth.tum");
  const auto scans = lines_of(folder.path() / "log.clf", "ROBOTLASER1");
  double squares = 0, count = 0;
  for (std::size_t k = 0; k < scans.size(); k += 7) {
    const double start = std::stod(scans[k][2]), step = std::stod(scans[k][4]);
    EXPECT_NEAR(start + 60 * step, -start, 1e-7);
    for (std::size_t beam = 0; beam < 61; ++beam) {
      const double range = std::stod(scans[k][9 + beam]);
      if (range >= 10) continue;
      const double angle = start + static_cast<double>(beam) * step;
      const Eigen::Vector3d point =
          truth.T_world_frame[k] *
          Eigen::Vector3d(range * std::cos(angle), range * std::sin(angle), 0);
      const double error = clearance(walls, point.head<2>());
      EXPECT_LT(error, 0.04);
      squares += error * error, ++count;
    }
  }
  EXPECT_GT(count, 1000);
  EXPECT_LT(std::sqrt(squares / count), 0.0105);  // along the beam it is 0.01
}

TEST(Indoor, ReplacesAStreetAndAStreetReplacesIt) {
  const TestFolder folder;
  simulate(small_scene("city_loop", 3, 10), folder.path());
  simulate(small("rooms"), folder.path());
  EXPECT_FALSE(fs::exists(folder.path() / "frames"));
  simulate(small_scene("city_loop", 3, 10), folder.path());
  EXPECT_FALSE(fs::exists(folder.path() / "log.clf"));
  folder.write("notes.txt", "mine");
  EXPECT_THAT(refusal([&] { simulate(small("rooms"), folder.path()); }),
              HasSubstr("name another folder"));
}

TEST(Indoor, TheDriftThatIsNotAskedSuitsTheBuilding) {
  EXPECT_NEAR(*set_up(small("lookalike")).scene.drift, 2, 1e-12);  // 40 % of 5 m
  const IndoorStage stage = set_up(small("corridor"));
  EXPECT_NEAR(*stage.scene.drift, 0.03 * way_length(stage.drive.poses), 1e-9);
}

TEST(IndoorScene, SaysWhatIsWrongAndWhatWasMeant) {
  const auto refused = [](const std::string& text) {
    const TestFolder folder;
    folder.write("scene.yaml", text);
    return refusal([&] { settled(read_indoor_scene(folder.path() / "scene.yaml")); });
  };
  EXPECT_EQ(refused("path: rooms\nnoise: 2 cm\nturn_rate: 5 deg/s\n"), "(nothing was refused)");
  EXPECT_THAT(refused("path: corridor\nlines: 5\n"), HasSubstr("scene.yaml:2:1: unknown option"));
  EXPECT_THAT(refused("path: corridor\nspeed: 1 m\n"), HasSubstr("ends in 'm'"));
  EXPECT_THAT(refused("path: corridor\nrate: 5\n"), HasSubstr("lacks its unit"));
  EXPECT_THAT(refused("path: corridor\ndrop_in_turns: 1.5\n"), HasSubstr("out of range"));
  EXPECT_THAT(refused("path: corridor\ncolumns: 7\n"), HasSubstr("out of range"));
  EXPECT_THAT(refused("path: coridor\n"), HasSubstr("did you mean 'corridor'?"));
  EXPECT_THAT(refused("path: rooms\noverlap: 12 m\n"), HasSubstr("at most 10 m less"));
  EXPECT_THAT(refused("path: [rooms]\n"), HasSubstr("takes one value"));
}

TEST(IndoorScene, LeavesNothingBehindWhenItRefuses) {
  const TestFolder folder;
  IndoorScene scene = small("rooms");
  scene.kidnap = 90;
  EXPECT_THAT(refusal([&] { simulate(scene, folder.path() / "log"); }), HasSubstr("too short"));
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

}  // namespace
}  // namespace plumb::simulate
