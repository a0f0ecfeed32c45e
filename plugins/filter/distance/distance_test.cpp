#include "distance.hpp"

#include <gmock/gmock.h>

#include <limits>

#include "plumb/data/error.hpp"
#include "plumb/plugin/module.hpp"
#include "plumb/plugin/testing.hpp"
#include "plumb/slam/step.hpp"

extern "C" const PlumbModule* plumb_module();

namespace plumb::filter_distance {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

Cloud on_x(std::vector<float> x) {
  Cloud cloud;
  for (const float value : x) cloud.add({value, 0, 0});
  return cloud;
}

TEST(FilterDistance, KeepsTheShellWithBothItsBounds) {
  const Shell shell = within_shell(on_x({0.4f, 0.5f, -10, 300, 301, -0.1f}), 0.5f, 300);
  EXPECT_THAT(shell.cloud.x, ElementsAre(0.5f, -10, 300));
  EXPECT_EQ(shell.nearer, 2u);
  EXPECT_EQ(shell.farther, 1u);
}

TEST(FilterDistance, MeasuresInSpace) {
  Cloud cloud;
  cloud.add({3, 4, 12});  // 13 m away
  EXPECT_EQ(within_shell(cloud, 12.9f, 13.1f).cloud.size(), 1u);
  EXPECT_EQ(within_shell(cloud, 0, 12.9f).cloud.size(), 0u);
}

TEST(FilterDistance, TakesEveryArrayAlong) {
  Cloud cloud = on_x({0, 5, 6});
  cloud.intensity = {10, 20, 30};
  cloud.ring = {1, 2, 3};
  const Shell shell = within_shell(cloud, 1, 100);
  EXPECT_THAT(shell.cloud.intensity, ElementsAre(20, 30));
  EXPECT_THAT(shell.cloud.ring, ElementsAre(2, 3));
}

TEST(FilterDistance, DropsWhatIsNoNumber) {
  const float nan = std::numeric_limits<float>::quiet_NaN(),
              inf = std::numeric_limits<float>::infinity();
  EXPECT_THAT(within_shell(on_x({nan, 1, inf, -inf}), 0, 100).cloud.x, ElementsAre(1));
}

TEST(FilterDistance, GivesAnEmptyCloudForAnEmptyOne) {
  EXPECT_THAT(within_shell(Cloud(), 0.5f, 300).cloud.x, IsEmpty());
}

TEST(FilterDistance, KeepsTheFramesPlaceAndCountsWhatItDropped) {
  const Step& step = *plumb_module()->steps[0];
  PortInput input;
  input.wired = true;
  input.one = any_value(Frame{7, on_x({0.1f, 2, 500, 600})});
  PortOutput output;
  TestContext context;
  step.run(step.parameters({}).get(), {&input, 1}, {&output, 1}, context);
  EXPECT_EQ(output.one.as<Frame>()->index, 7u);
  EXPECT_THAT(output.one.as<Frame>()->cloud.x, ElementsAre(2));
  EXPECT_EQ(context.counts["points nearer than min_range dropped"], 1u);
  EXPECT_EQ(context.counts["points farther than max_range dropped"], 2u);
}

TEST(FilterDistance, RefusesBoundsThatLeaveNothing) {
  EXPECT_THROW(plumb_module()->steps[0]->parameters({{"min_range", 5.0}, {"max_range", 5.0}}),
               Error);
}

}  // namespace
}  // namespace plumb::filter_distance
