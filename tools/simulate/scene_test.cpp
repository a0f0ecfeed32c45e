#include "simulate/scene.hpp"

#include <gmock/gmock.h>

#include "simulate/testing.hpp"

namespace plumb::simulate {
namespace {

using testing::HasSubstr;

Scene read(const std::string& text) {
  const TestFolder folder;
  folder.write("scene.yaml", text);
  return read_scene(folder.path() / "scene.yaml");
}

std::string refused(const std::string& text) {
  return refusal([&] { read(text); });
}

TEST(Scene, ReadsQuantitiesWithTheirUnits) {
  const Scene scene = read(
      "path: blocks\nlength: 2.9 km\nnoise: 2 cm\nlowest: -25 deg\nspeed: 36 km/h\nlines: 32\n");
  EXPECT_EQ(scene.path, "blocks");
  EXPECT_EQ(scene.length, 2900);
  EXPECT_EQ(scene.noise, 0.02);
  EXPECT_NEAR(scene.lowest, -0.43633, 1e-5);
  EXPECT_NEAR(*scene.speed, 10, 1e-12);
  EXPECT_EQ(scene.lines, 32);
}

TEST(Scene, ReadsBackWhatItWrote) {
  Scene scene = settled(small_scene("figure_eight", 77, 123.456789012345));
  scene.lowest = -0.123456789012345678;
  scene.noise = 1.0 / 3;
  const Scene back = read(scene_text(scene));
  EXPECT_EQ(back.path, scene.path);
  EXPECT_EQ(back.frames, scene.frames);
  EXPECT_EQ(back.length, scene.length);
  EXPECT_EQ(back.lowest, scene.lowest);
  EXPECT_EQ(back.highest, scene.highest);
  EXPECT_EQ(back.noise, scene.noise);
  EXPECT_EQ(back.drift, scene.drift);
  EXPECT_EQ(scene_text(back), scene_text(scene));
  EXPECT_THAT(scene_text(Scene()), HasSubstr("lowest: -16.6 deg"));
}

TEST(Scene, FilesLieBesideTheScene) {
  const Scene scene = read("path: drive.tum\ndrift_from: [../odometry.tum, drive.tum]\n");
  EXPECT_THAT(scene.path, testing::EndsWith("/drive.tum"));
  EXPECT_TRUE(std::filesystem::path(scene.drift_odometry).is_absolute());
}

TEST(Scene, OfFramesLengthAndSpeedTwoSayTheThird) {
  Scene scene;
  EXPECT_EQ(settled(scene).frames, 1001);
  scene.frames = 201;
  EXPECT_EQ(settled(scene).length, 200);
  scene.speed = 5;
  EXPECT_EQ(settled(scene).length, 100);
  scene.length = 300;
  EXPECT_THAT(refusal([&] { settled(scene); }), HasSubstr("two say the third"));
  scene.frames.reset();
  EXPECT_EQ(settled(scene).frames, 601);
  EXPECT_NEAR(*settled(scene).drift, 300 * 10.0 / 2900, 1e-12);
}

TEST(Scene, SaysWhereAMistakeIsAndWhatWasMeant) {
  EXPECT_THAT(refused("path: blocks\nnoize: 2 cm\n"),
              testing::AllOf(HasSubstr("scene.yaml:2:1:"), HasSubstr("did you mean 'noise'?")));
  EXPECT_THAT(refused("noise: 2\n"),
              testing::AllOf(HasSubstr("scene.yaml:1:8:"), HasSubstr("lacks its unit")));
  EXPECT_THAT(refused("noise: 2 deg\n"), HasSubstr("ends in 'deg'"));
  EXPECT_THAT(refused("noise: two cm\n"), HasSubstr("is not a number"));
  EXPECT_THAT(refused("noise: 2 km\n"), HasSubstr("out of range"));
  EXPECT_THAT(refused("lines: 6.5\n"), HasSubstr("not a whole number"));
  EXPECT_THAT(refused("lines: 0\n"), HasSubstr("out of range"));
  EXPECT_THAT(refused("frames: 1\n"), HasSubstr("out of range"));
  EXPECT_THAT(refused("seed: 1\nseed: 2\n"), HasSubstr("scene.yaml:2:1: 'seed' is given twice"));
  EXPECT_THAT(refused("path: city_lop\n"), HasSubstr("did you mean 'city_loop'?"));
  EXPECT_THAT(refused("path: [a, b]\n"), HasSubstr("takes one value"));
  EXPECT_THAT(refused("drift_from: a.tum\n"), HasSubstr("takes two files"));
  EXPECT_THAT(refused("- a\n"), HasSubstr("is not a map"));
  EXPECT_THAT(refused("path: {a\n"), HasSubstr("scene.yaml:"));
}

TEST(Scene, RefusesOptionsThatContradictEachOther) {
  Scene scene;
  scene.drift = 3;
  scene.drift_odometry = scene.drift_truth = "a.tum";
  EXPECT_THAT(refusal([&] { settled(scene); }), HasSubstr("leave one of them out"));
  Scene upside_down;
  upside_down.lowest = 1;
  EXPECT_THAT(refusal([&] { settled(upside_down); }), HasSubstr("exchange the two angles"));
  Scene file;
  file.path = "drive.tum";
  file.length = 100;
  EXPECT_THAT(refusal([&] { settled(file); }), HasSubstr("leave 'length' and 'speed' out"));
}

}  // namespace
}  // namespace plumb::simulate
