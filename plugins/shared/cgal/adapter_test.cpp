#include "shared/cgal/adapter.hpp"

#include <gtest/gtest.h>

#include "plumb/slam/cloud_testing.hpp"

namespace plumb::cgal {
namespace {

TEST(Adapter, CopiesCoordinatesAsTheyAre) {
  const Cloud cloud = full_cloud(5);
  const auto points = points_of(cloud);
  ASSERT_EQ(points.size(), 5u);
  for (std::size_t k = 0; k < 5; ++k) {
    EXPECT_EQ(points[k].x(), static_cast<double>(cloud.x[k]));
    EXPECT_EQ(points[k].y(), static_cast<double>(cloud.y[k]));
    EXPECT_EQ(points[k].z(), static_cast<double>(cloud.z[k]));
    EXPECT_EQ(eigen_of(vector_of(cloud.normal(k))), cloud.normal(k).cast<double>().eval());
  }
  EXPECT_TRUE(point_of(Eigen::Vector3d(1, 2, 3)) == Point(1, 2, 3));
  EXPECT_TRUE(points_of(Cloud()).empty());
}

}  // namespace
}  // namespace plumb::cgal
