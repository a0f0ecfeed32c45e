#include "plumb/slam/step.hpp"

#include "plumb/plugin/step_testing.hpp"

namespace plumb::describe_esf {
namespace {

Segment cube() {
  Cloud cloud;
  for (int k = 0; k < 512; ++k)
    cloud.add(
        {static_cast<float>(k % 8), static_cast<float>(k / 8 % 8), static_cast<float>(k / 64)});
  return Segment().with(cloud, std::vector<std::uint16_t>(512, 0));
}

TEST(DescribeEsfStep, TakesItsSeedFromTheContext) {
  const auto described = [](std::uint64_t seed, std::int64_t number = 0) {
    TestContext context(seed);
    return StepUnderTest(*plumb_module())
        .with("segment", cube())
        .set("samples", std::int64_t{2000})
        .set("seed", number)
        .run<Descriptor>("descriptor", context)
        .values;
  };
  EXPECT_EQ(described(1).size(), 640u);
  EXPECT_EQ(described(1), described(1));
  EXPECT_NE(described(1), described(2));
  EXPECT_EQ(described(1), described(1, 0));
  EXPECT_NE(described(1), described(1, 1));
  EXPECT_NE(described(1, 1), described(1, 2));
}

TEST(DescribeEsfStep, SaysWhereASegmentHasNoShape) {
  TestContext context;
  const auto descriptor = StepUnderTest(*plumb_module())
                              .with("segment", Segment())
                              .run<Descriptor>("descriptor", context);
  EXPECT_EQ(descriptor.values, std::vector<float>(640, 0.0f));
  ASSERT_EQ(context.warnings.size(), 1u);
}

}  // namespace
}  // namespace plumb::describe_esf
