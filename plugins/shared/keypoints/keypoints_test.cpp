#include <gmock/gmock.h>

#include <limits>

#include "plumb/data/random.hpp"
#include "shared/keypoints/nearest_points.hpp"
#include "shared/keypoints/one_per_voxel.hpp"

namespace plumb::keypoints {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

Cloud with_normals(const std::vector<Eigen::Vector3f>& points) {
  Cloud cloud;
  for (const auto& p : points) {
    cloud.add(p);
    cloud.nx.push_back(0), cloud.ny.push_back(0), cloud.nz.push_back(1);
  }
  return cloud;
}

TEST(OnePerVoxel, TakesThePointInTheMiddleOfEachVoxel) {
  const Cloud cloud =
      with_normals({{0.1f, 0, 0}, {0.5f, 0, 0}, {0.8f, 0, 0}, {-0.2f, 0, 0}, {5, 5, 5}});
  EXPECT_THAT(one_per_voxel(cloud, 1), ElementsAre(1, 3, 4));
}

TEST(OnePerVoxel, PassesOverPointsWithoutPlaceOrNormal) {
  Cloud cloud = with_normals({{0.1f, 0, 0}, {0.5f, 0, 0}, {0.9f, 0, 0}});
  cloud.nz[1] = 0;
  cloud.x[2] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THAT(one_per_voxel(cloud, 1), ElementsAre(0));
  Cloud bare;
  bare.add({0, 0, 0});
  EXPECT_THAT(one_per_voxel(bare, 1), IsEmpty());
}

TEST(NearestPoints, AreTheKeypointsThemselvesWhereTheyAreOfTheCloud) {
  Random random(3);
  Cloud cloud;
  for (int k = 0; k < 500; ++k) {
    Eigen::Vector3f p;
    for (int c = 0; c < 3; ++c) p[c] = static_cast<float>(10 * random.uniform());
    cloud.add(p);
  }
  const std::vector<std::uint32_t> chosen{3, 77, 240, 499};
  EXPECT_EQ(nearest_points(SearchTree(cloud), select(cloud, chosen)), chosen);
}

TEST(NearestPoints, NameAPointOnceAndNoneInAnEmptyCloud) {
  Cloud cloud;
  for (const float x : {0.f, 1.f, 2.f}) cloud.add({x, 0, 0});
  Cloud keypoints;
  for (const float x : {1.9f, 2.2f, 0.1f}) keypoints.add({x, 0, 0});
  EXPECT_THAT(nearest_points(SearchTree(cloud), keypoints), ElementsAre(0, 2));
  EXPECT_THAT(nearest_points(SearchTree(Cloud()), keypoints), IsEmpty());
}

}  // namespace
}  // namespace plumb::keypoints
