#include <gmock/gmock.h>
#include <png.h>

#include <limits>

#include "map_image.hpp"
#include "plumb/data/document.hpp"
#include "plumb/plugin/step_testing.hpp"
#include "plumb/slam/step.hpp"

namespace plumb::write_map2d {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// Three columns, two rows; upper row (larger y): occupied, free, unknown; lower row: undecided,
/// never seen, occupied.
GridMap sample() {
  GridMap map;
  map.resolution = 0.05;
  map.origin = {-1.25, 2.5};
  map.columns = 3;
  map.rows = 2;
  map.log_odds = {0.3f, 0, 2, 3.5f, -2, 0};
  return map;
}

Document written(const std::string& port, const std::string& name = "map") {
  TestContext context;
  return StepUnderTest(*plumb_module())
      .with("map", sample())
      .set("name", name)
      .run<Document>(port, context);
}

TEST(WriteMap2d, WritesPgmWithTheTopRowFirst) {
  const auto document = written("pgm");
  EXPECT_EQ(document.name, "map.pgm");
  const std::string header = "P5\n3 2\n255\n";
  const std::string bytes = document.bytes.text();
  ASSERT_TRUE(bytes.starts_with(header));
  std::vector<int> pixels;
  for (const char c : bytes.substr(header.size())) pixels.push_back(static_cast<std::uint8_t>(c));
  EXPECT_THAT(pixels, ElementsAre(0, 254, 205, 205, 205, 0));
}

TEST(WriteMap2d, WritesTheYamlThatMapServerReads) {
  const auto document = written("yaml", "floor");
  EXPECT_EQ(document.name, "floor.yaml");
  EXPECT_EQ(
      document.bytes.text(),
      "image: floor.pgm\nmode: trinary\nresolution: 0.05\norigin: [-1.25, 2.5, 0.0]\nnegate: 0\n"
      "occupied_thresh: 0.65\nfree_thresh: 0.196\n");
}

TEST(WriteMap2d, IsReadBackByMapServersRuleAsItWasDecided) {
  // map_server: p = (255 - grey) / 255; occupied above occupied_thresh, free below free_thresh,
  // else unknown.
  const auto read = [](int grey) {
    const double p = (255 - grey) / 255.0;
    return p > 0.65 ? 'o' : p < 0.196 ? 'f' : '?';
  };
  EXPECT_EQ(read(0), 'o');
  EXPECT_EQ(read(254), 'f');
  EXPECT_EQ(read(205), '?');
}

TEST(WriteMap2d, WritesAPngThatLibpngReadsBack) {
  const auto document = written("png");
  const std::string bytes = document.bytes.text();
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  ASSERT_TRUE(png_image_begin_read_from_memory(&png, bytes.data(), bytes.size()));
  EXPECT_EQ(png.width, 3u);
  EXPECT_EQ(png.height, 2u);
  png.format = PNG_FORMAT_GRAY;
  std::vector<std::uint8_t> pixels(6);
  ASSERT_TRUE(png_image_finish_read(&png, nullptr, pixels.data(), 0, nullptr));
  EXPECT_THAT(pixels, ElementsAre(12, 255, 205, 174, 205, 49));
}

TEST(WriteMap2d, RefusesNamesWithAFolderAndMapsWithoutCells) {
  const Step& step = *plumb_module()->steps[0];
  EXPECT_THROW(step.parameters({{"name", std::string("../map")}}), Error);
  EXPECT_THROW(step.parameters({{"occupied", 0.65}, {"free", 0.7}}), Error);
  TestContext context;
  EXPECT_THROW(StepUnderTest(*plumb_module()).with("map", GridMap()).run<Document>("pgm", context),
               Error);
}

}  // namespace
}  // namespace plumb::write_map2d
