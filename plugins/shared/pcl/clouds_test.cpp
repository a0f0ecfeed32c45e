#include "shared/pcl/clouds.hpp"

#include <gmock/gmock.h>
#include <pcl/console/print.h>

#include "plumb/data/error.hpp"
#include "shared/pcl/street_testing.hpp"

namespace plumb::pcl {
namespace {

using testing::ElementsAre;

TEST(Clouds, HoldEachPointInItsPlace) {
  const Cloud cloud = street_corner(500, 1);
  const auto points = points_of(cloud);
  ASSERT_EQ(points->size(), 500u);
  EXPECT_TRUE(points->is_dense);
  EXPECT_FALSE(points->isOrganized());
  for (std::size_t k = 0; k < 500; ++k)
    EXPECT_EQ(Eigen::Vector3f((*points)[k].getVector3fMap()), cloud.point(k)) << k;
  const std::vector<Eigen::Vector3f> two{{1, 2, 3}, {4, 5, 6}};
  EXPECT_EQ((*points_of(two))[1].z, 6);
}

TEST(Clouds, LeaveOutPointsWithoutNormalAndKnowWhichTheyKept) {
  Cloud cloud = street_corner(4, 1);
  cloud.nx[1] = cloud.ny[1] = cloud.nz[1] = 0;
  const Oriented of = oriented(cloud);
  EXPECT_THAT(of.index, ElementsAre(0, 2, 3));
  ASSERT_EQ(of.points->size(), 3u);
  ASSERT_EQ(of.normals->size(), 3u);
  EXPECT_EQ((*of.points)[1].x, cloud.x[2]);
  EXPECT_EQ(Eigen::Vector3f((*of.normals)[1].getNormalVector3fMap()), cloud.normal(2));
}

TEST(Clouds, SayWhatNormalsComeFrom) {
  Cloud bare;
  bare.add({1, 2, 3});
  EXPECT_THROW(oriented(bare), Error);
  EXPECT_EQ(oriented(Cloud()).size(), 0u);
}

TEST(Clouds, SilencePcl) {
  points_of(Cloud());
  EXPECT_FALSE(::pcl::console::isVerbosityLevelEnabled(::pcl::console::L_ERROR));
}

}  // namespace
}  // namespace plumb::pcl
