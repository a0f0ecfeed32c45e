#include "gasd.hpp"

#include <pcl/features/gasd.h>

#include <cmath>
#include <numeric>

#include "shared/pcl/clouds.hpp"

namespace plumb::describe_gasd {
namespace {

/// The sum of the cubes of the points' first coordinates after `transform`: which side of the
/// centroid has the longer tail.
double skew(const pcl::Points& points, const Eigen::Matrix4f& transform) {
  const Eigen::RowVector4f row = transform.row(0);
  double sum = 0;
  for (const auto& p : points) {
    const double x = row[0] * p.x + row[1] * p.y + row[2] * p.z + row[3];
    sum += x * x * x;
  }
  return sum;
}

/// The numbers of the cloud turned half round its z axis.
std::vector<float> half_turned(const std::vector<float>& values) {
  std::vector<float> result(values.size());
  for (std::size_t i = 0; i < gasd_side; ++i)
    for (std::size_t j = 0; j < gasd_side; ++j)
      for (std::size_t k = 0; k < gasd_side; ++k)
        result[(i * gasd_side + j) * gasd_side + k] =
            values[((gasd_side - 1 - i) * gasd_side + gasd_side - 1 - j) * gasd_side + k];
  return result;
}

bool no_extent(const Cloud& cloud) {
  const Box box = box_of(cloud);
  return !((box.high - box.low).norm() > 0);
}

}  // namespace

std::optional<std::vector<float>> gasd(const Cloud& cloud, Interpolation interpolation) {
  // PCL divides by the distance of the farthest point from the centroid.
  if (cloud.size() < 3 || no_extent(cloud)) return std::nullopt;
  const auto points = pcl::points_of(cloud);
  ::pcl::GASDEstimation<::pcl::PointXYZ, ::pcl::GASDSignature512> estimate(
      Eigen::Vector3f::UnitZ(), gasd_side / 2, 1,
      interpolation == Interpolation::none ? ::pcl::INTERP_NONE : ::pcl::INTERP_QUADRILINEAR);
  estimate.setInputCloud(points);
  ::pcl::PointCloud<::pcl::GASDSignature512> signature;
  estimate.compute(signature);

  std::vector<float> values(std::begin(signature[0].histogram), std::end(signature[0].histogram));
  const double sum = std::accumulate(values.begin(), values.end(), 0.0);
  if (!(sum > 0) || !std::isfinite(sum)) return std::nullopt;
  for (auto& value : values) value = static_cast<float>(value / sum);
  return skew(*points, estimate.getTransform()) < 0 ? half_turned(values) : values;
}

}  // namespace plumb::describe_gasd
