#include "radius_outlier.hpp"

#include <gmock/gmock.h>

#include "plumb/plugin/step_testing.hpp"
#include "plumb/slam/step.hpp"
#include "shared/pcl/street_testing.hpp"

namespace plumb::filter_radius_outlier {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

TEST(RadiusOutlier, CountsTheOthersWithinTheRadius) {
  Cloud cloud;
  for (const float x : {0.f, 1.f, 2.f, 2.5f, 10.f}) cloud.add({x, 0, 0});
  EXPECT_THAT(not_alone(cloud, 1.2, 1), ElementsAre(0, 1, 2, 3));
  EXPECT_THAT(not_alone(cloud, 1.2, 2), ElementsAre(1, 2));
  EXPECT_THAT(not_alone(cloud, 1.2, 3), IsEmpty());
  EXPECT_THAT(not_alone(cloud, 1.2, 100), IsEmpty());
  EXPECT_THAT(not_alone(cloud, 20, 4), ElementsAre(0, 1, 2, 3, 4));
}

TEST(RadiusOutlier, IsWhatComparingAllPointsGives) {
  const Cloud cloud = pcl::street_corner(3000, 1);
  for (const std::uint32_t least : {3u, 12u, 20u}) {
    std::vector<std::uint32_t> expected;
    for (std::uint32_t k = 0; k < cloud.size(); ++k) {
      std::uint32_t others = 0;
      for (std::uint32_t m = 0; m < cloud.size(); ++m)
        others += m != k && (cloud.point(k) - cloud.point(m)).squaredNorm() <= 0.64f;
      if (others >= least) expected.push_back(k);
    }
    EXPECT_EQ(not_alone(cloud, 0.8, least), expected);
  }
}

TEST(RadiusOutlier, OfNothingIsNothing) { EXPECT_THAT(not_alone(Cloud(), 1, 1), IsEmpty()); }

TEST(RadiusOutlierStep, RemovesBirdsAndKeepsWhatIsKnownOfTheOthers) {
  Cloud cloud = pcl::street_corner(5000, 2);
  for (int k = 0; k < 20; ++k) {
    cloud.add({static_cast<float>(k), 6, 30});
    cloud.nx.push_back(0), cloud.ny.push_back(0), cloud.nz.push_back(1);
  }
  TestContext context;
  const auto result = StepUnderTest(*plumb_module())
                          .with("segment", pcl::segment_of(cloud))
                          .run<Segment>("segment", context);
  EXPECT_GE(result.cloud.size(), 4990u);
  EXPECT_LT(result.box.high.z(), 6);
  EXPECT_TRUE(result.cloud.has_normals());
  EXPECT_EQ(result.frame.size(), result.cloud.size());
  EXPECT_EQ(context.counts["outliers removed"], cloud.size() - result.cloud.size());
}

}  // namespace
}  // namespace plumb::filter_radius_outlier
