#include "covariance_sampling.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <numeric>

#include "plumb/plugin/step_testing.hpp"
#include "plumb/slam/step.hpp"
#include "shared/pcl/street_testing.hpp"
#include "shared/pcl/tunnel_testing.hpp"

namespace plumb::filter_covariance_sampling {
namespace {

using pcl::segment_of;
using pcl::tunnel;

TEST(CovarianceSampling, FixesBetterWhatIsFixedLeast) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const Cloud cloud = tunnel(4000, 33, seed);
    const auto kept = stable_points(cloud, 800);
    ASSERT_EQ(kept.size(), 800u);
    EXPECT_TRUE(std::ranges::is_sorted(kept));
    EXPECT_TRUE(std::ranges::adjacent_find(kept) == kept.end());
    EXPECT_GT(pcl::least_fixed(select(cloud, kept)), pcl::least_fixed(pcl::thinned(cloud, 5)));
  }
}

TEST(CovarianceSampling, GivesTheSameAgain) {
  const Cloud cloud = tunnel(3000, 20, 4);
  EXPECT_EQ(stable_points(cloud, 500), stable_points(cloud, 500));
}

TEST(CovarianceSampling, KeepsAllWhereThereAreNoMore) {
  Cloud cloud = tunnel(50, 10, 5);
  std::vector<std::uint32_t> all(50);
  std::iota(all.begin(), all.end(), 0);
  EXPECT_EQ(stable_points(cloud, 50), all);
  EXPECT_EQ(stable_points(cloud, 100), all);
  EXPECT_TRUE(stable_points(cloud, 0).empty());
  EXPECT_TRUE(stable_points(Cloud(), 10).empty());
  cloud.nx[7] = cloud.ny[7] = cloud.nz[7] = 0;
  all.erase(all.begin() + 7);
  EXPECT_EQ(stable_points(cloud, 50), all);
}

TEST(CovarianceSamplingStep, KeepsAShareOfThePoints) {
  TestContext context;
  StepUnderTest step(*plumb_module());
  step.with("segment", segment_of(tunnel(2000, 30, 6))).set("fraction", 0.25);
  const auto kept = step.run<Segment>("segment", context);
  EXPECT_EQ(kept.cloud.size(), 500u);
  EXPECT_TRUE(kept.cloud.has_normals());
  EXPECT_EQ(kept.frame.size(), 500u);
  Cloud bare;
  for (int k = 0; k < 10; ++k) bare.add({static_cast<float>(k), 0, 0});
  step.with("segment", segment_of(bare));
  EXPECT_THROW(step.run<Segment>("segment", context), Error);
}

}  // namespace
}  // namespace plumb::filter_covariance_sampling
