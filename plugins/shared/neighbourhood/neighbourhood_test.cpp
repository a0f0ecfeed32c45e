#include <gmock/gmock.h>

#include <algorithm>

#include "plumb/plugin/testing.hpp"
#include "shared/neighbourhood/normals.hpp"

namespace plumb::neighbourhood {
namespace {

Cloud in_a_cube(std::size_t count) {
  Random random(3);
  const auto u = [&] { return static_cast<float>(4 * random.uniform()); };
  Cloud cloud;
  for (std::size_t k = 0; k < count; ++k) {
    const float x = u(), y = u(), z = u();
    cloud.add({x, y, z});
  }
  return cloud;
}

/// Distances from point k to the others and itself, in order.
std::vector<float> distances(const Cloud& cloud, std::size_t k) {
  std::vector<float> all;
  for (std::size_t m = 0; m < cloud.size(); ++m)
    all.push_back((cloud.point(m) - cloud.point(k)).norm());
  std::ranges::sort(all);
  return all;
}

TEST(Finder, FindsTheNearestOnesWithinTheRadius) {
  const Cloud cloud = in_a_cube(400);
  const SearchTree tree(cloud);
  for (const Bounds& bounds : {Bounds{0.8, {}}, Bounds{{}, 12}, Bounds{0.8, 12}}) {
    Finder finder(cloud, tree, bounds);
    for (std::size_t k = 0; k < cloud.size(); k += 37) {
      auto expected = distances(cloud, k);
      if (bounds.radius) std::erase_if(expected, [](float d) { return d > 0.8f; });
      if (bounds.most) expected.resize(std::min<std::size_t>(expected.size(), *bounds.most));
      std::vector<float> found;
      for (const auto& p : finder.around(k)) found.push_back(p.norm());
      std::ranges::sort(found);
      ASSERT_EQ(found.size(), expected.size()) << k;
      for (std::size_t n = 0; n < found.size(); ++n) EXPECT_NEAR(found[n], expected[n], 1e-5);
      EXPECT_EQ(found[0], 0) << "the point itself";
    }
  }
}

TEST(Finder, FindsNothingAroundWhatIsNoPlace) {
  Cloud cloud = in_a_cube(10);
  cloud.y[3] = std::numeric_limits<float>::infinity();
  const SearchTree tree(cloud);
  Finder finder(cloud, tree, {{}, 5});
  EXPECT_TRUE(finder.around(3).empty());
  EXPECT_EQ(finder.around(4).size(), 5u);
}

TEST(WriteNormals, TurnsWhatIsSaidToTheSensorAndCountsWhatIsNot) {
  Cloud cloud;
  for (int k = 0; k < 3000; ++k) cloud.add({static_cast<float>(k), 0, 0});
  TestContext context;
  const auto origin = [](std::size_t k) { return Eigen::Vector3f(0, 0, k % 2 ? 9.f : -9.f); };
  const std::size_t without = write_normals(
      cloud, SearchTree(cloud), {1.5, {}}, origin, context, [](const auto& neighbours) {
        return neighbours.size() == 3 ? Eigen::Vector3f::UnitZ().eval()
                                      : Eigen::Vector3f::Zero().eval();
      });
  EXPECT_EQ(without, 2u) << "the two ends have one neighbour";
  EXPECT_TRUE(cloud.normal(0).isZero());
  for (std::size_t k = 1; k < 2999; ++k) EXPECT_EQ(cloud.nz[k], k % 2 ? 1.f : -1.f);
}

}  // namespace
}  // namespace plumb::neighbourhood
