#include "shared/thinning/voxel_means.hpp"

#include <gmock/gmock.h>

#include <limits>

#include "plumb/data/error.hpp"
#include "plumb/data/random.hpp"

namespace plumb::thinning {
namespace {

using testing::ElementsAre;

Cloud scattered(std::size_t n, std::uint64_t seed) {
  Random random(seed);
  const auto u = [&] { return static_cast<float>(20 * (random.uniform() - 0.5)); };
  Cloud cloud;
  for (std::size_t k = 0; k < n; ++k) {
    const float x = u(), y = u(), z = u();
    cloud.add({x, y, z});
  }
  return cloud;
}

TEST(VoxelMeans, OfManyCloudsAreThoseOfOneWithAllTheirPoints) {
  Cloud all;
  VoxelMeans in_parts(1), at_once(1);
  for (const std::uint64_t seed : {1, 2, 3}) {
    const Cloud part = scattered(3000, seed);
    in_parts.add(part, {}, {});
    for (std::size_t k = 0; k < part.size(); ++k) all.add(part.point(k));
  }
  at_once.add(all, {}, {});
  const auto a = in_parts.take(), b = at_once.take();
  EXPECT_LT(a.cloud.size(), 9000u);
  EXPECT_EQ(a.cloud.x, b.cloud.x);
  EXPECT_EQ(a.cloud.y, b.cloud.y);
  EXPECT_EQ(a.cloud.z, b.cloud.z);
}

TEST(VoxelMeans, NameTheFrameThatSawACellFromNearest) {
  VoxelMeans means(1);
  Cloud cloud;
  cloud.add({0.25f, 0.5f, 0.5f}), cloud.add({0.75f, 0.5f, 0.5f}), cloud.add({5.5f, 0.5f, 0.5f});
  means.add(cloud, {0, 1, 0}, {{10, 0, 0}, {1, 0, 0}});
  const auto result = means.take();
  EXPECT_THAT(result.frame, ElementsAre(1, 0));
  EXPECT_THAT(result.cloud.x, ElementsAre(0.5f, 5.5f));
}

TEST(VoxelMeans, LeaveOutWhatIsNowhereAndRefuseWhatIsTooWide) {
  VoxelMeans means(0.5);
  Cloud cloud;
  cloud.add({0, 0, 0}), cloud.add({std::numeric_limits<float>::quiet_NaN(), 0, 0});
  means.add(cloud, {}, {});
  Cloud far;
  far.add({2e6f, 0, 0});
  EXPECT_THROW(means.add(far, {}, {}), Error);
  const auto result = means.take();
  EXPECT_EQ(result.dropped, 1u);
  EXPECT_EQ(result.cloud.size(), 1u);
}

}  // namespace
}  // namespace plumb::thinning
