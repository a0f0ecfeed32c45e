#include "normal_space.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <numeric>

#include "plumb/plugin/step_testing.hpp"
#include "plumb/slam/step.hpp"
#include "shared/pcl/street_testing.hpp"
#include "shared/pcl/tunnel_testing.hpp"

namespace plumb::filter_normal_space {
namespace {

using pcl::segment_of;
using pcl::tunnel;

TEST(NormalSpace, KeepsAsManyOfEachDirection) {
  const Cloud cloud = tunnel(4000, 33, 1);  // 122 of them across
  const auto kept = alike_in_normals(cloud, 300, 8, 5);
  ASSERT_EQ(kept.size(), 300u);
  EXPECT_TRUE(std::ranges::is_sorted(kept));
  EXPECT_TRUE(std::ranges::adjacent_find(kept) == kept.end());
  const Cloud chosen = select(cloud, kept);
  EXPECT_EQ(pcl::across(chosen), 100u);
  EXPECT_EQ(std::ranges::count_if(chosen.nz, [](float z) { return z > 0.5f; }), 100);
}

TEST(NormalSpace, GoesOnWithTheOthersWhereADirectionHasNoMore) {
  const Cloud cloud = tunnel(4000, 100, 2);  // 40 of them across
  const Cloud chosen = select(cloud, alike_in_normals(cloud, 300, 8, 5));
  EXPECT_EQ(pcl::across(chosen), 40u);
  EXPECT_EQ(std::ranges::count_if(chosen.nz, [](float z) { return z > 0.5f; }), 130);
  EXPECT_GT(pcl::least_fixed(chosen), pcl::least_fixed(pcl::thinned(cloud, 13)));
}

TEST(NormalSpace, IsTheSameForTheSameSeedOnly) {
  const Cloud cloud = tunnel(2000, 20, 3);
  EXPECT_EQ(alike_in_normals(cloud, 300, 8, 7), alike_in_normals(cloud, 300, 8, 7));
  EXPECT_NE(alike_in_normals(cloud, 300, 8, 7), alike_in_normals(cloud, 300, 8, 8));
}

TEST(NormalSpace, KeepsAllWhereThereAreNoMore) {
  Cloud cloud = tunnel(50, 10, 4);
  std::vector<std::uint32_t> all(50);
  std::iota(all.begin(), all.end(), 0);
  EXPECT_EQ(alike_in_normals(cloud, 50, 8, 1), all);
  EXPECT_TRUE(alike_in_normals(cloud, 0, 8, 1).empty());
  EXPECT_TRUE(alike_in_normals(Cloud(), 10, 8, 1).empty());
  cloud.nx[7] = cloud.ny[7] = cloud.nz[7] = 0;
  all.erase(all.begin() + 7);
  EXPECT_EQ(alike_in_normals(cloud, 49, 8, 1), all);
}

TEST(NormalSpaceStep, TakesItsSeedFromTheContext) {
  const auto kept = [](std::uint64_t seed) {
    TestContext context(seed);
    return StepUnderTest(*plumb_module())
        .with("segment", segment_of(tunnel(2000, 20, 5)))
        .set("fraction", 0.25)
        .run<Segment>("segment", context)
        .cloud.x;
  };
  EXPECT_EQ(kept(1).size(), 500u);
  EXPECT_EQ(kept(1), kept(1));
  EXPECT_NE(kept(1), kept(2));
}

}  // namespace
}  // namespace plumb::filter_normal_space
