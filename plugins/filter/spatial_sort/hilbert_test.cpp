#include "hilbert.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <set>

#include "plumb/plugin/step_testing.hpp"
#include "plumb/slam/cloud_testing.hpp"
#include "plumb/slam/step.hpp"

namespace plumb::filter_spatial_sort {
namespace {

/// All whole coordinates below `side`, in an order that is drawn.
Cloud shuffled_grid(int side, std::uint64_t seed) {
  Random random(seed);
  std::vector<Eigen::Vector3f> points;
  for (int x = 0; x < side; ++x)
    for (int y = 0; y < side; ++y)
      for (int z = 0; z < side; ++z) points.push_back(Eigen::Vector3i(x, y, z).cast<float>());
  Cloud cloud;
  while (!points.empty()) {
    std::swap(points[random.below(static_cast<std::uint32_t>(points.size()))], points.back());
    cloud.add(points.back());
    points.pop_back();
  }
  return cloud;
}
std::vector<std::uint32_t> sorted(std::vector<std::uint32_t> order) {
  std::ranges::sort(order);
  return order;
}
std::vector<std::uint32_t> counting(std::size_t count) {
  std::vector<std::uint32_t> all(count);
  std::iota(all.begin(), all.end(), 0);
  return all;
}

TEST(HilbertOrder, GoesFromNeighbourToNeighbourThroughAGrid) {
  for (const int side : {2, 4, 8}) {
    const Cloud cloud = shuffled_grid(side, 3);
    const auto order = hilbert_order(cloud);
    EXPECT_EQ(sorted(order), counting(cloud.size()));
    for (std::size_t k = 1; k < order.size(); ++k)
      EXPECT_EQ((cloud.point(order[k]) - cloud.point(order[k - 1])).norm(), 1) << side << " " << k;
  }
}

TEST(HilbertOrder, IsTheSameEveryTime) {
  const Cloud cloud = shuffled_grid(9, 4);
  EXPECT_EQ(hilbert_order(cloud), hilbert_order(cloud));
}

TEST(HilbertOrder, PutsWhatIsNoPlaceLast) {
  Cloud cloud = shuffled_grid(3, 5);
  cloud.x[2] = std::numeric_limits<float>::quiet_NaN();
  cloud.z[20] = std::numeric_limits<float>::infinity();
  const auto order = hilbert_order(cloud);
  EXPECT_EQ(sorted(order), counting(27));
  EXPECT_EQ(order[25], 2u);
  EXPECT_EQ(order[26], 20u);
  EXPECT_TRUE(hilbert_order(Cloud()).empty());
}

TEST(SpatialSort, KeepsAllThatIsKnownOfEachPoint) {
  const Cloud cloud = full_cloud(200);
  std::vector<std::uint16_t> frames;
  for (std::uint16_t k = 0; k < 200; ++k) frames.push_back(k);
  Segment segment;
  segment.range.end = 200;
  segment.range.T_segment_frame.resize(200);
  TestContext context;
  const auto result = StepUnderTest(*plumb_module())
                          .with("segment", segment.with(cloud, frames))
                          .run<Segment>("segment", context);
  ASSERT_EQ(result.cloud.size(), 200u);
  std::set<std::uint16_t> seen;
  for (std::size_t k = 0; k < 200; ++k) {
    const std::size_t from = result.frame[k];
    seen.insert(result.frame[k]);
    EXPECT_EQ(result.cloud.point(k), cloud.point(from));
    EXPECT_EQ(result.cloud.normal(k), cloud.normal(from));
    EXPECT_EQ(result.cloud.intensity[k], cloud.intensity[from]);
    EXPECT_EQ(result.cloud.ring[k], cloud.ring[from]);
  }
  EXPECT_EQ(seen.size(), 200u);
}

}  // namespace
}  // namespace plumb::filter_spatial_sort
