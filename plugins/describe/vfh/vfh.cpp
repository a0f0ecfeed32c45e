#include "vfh.hpp"

#include <pcl/features/vfh.h>

#include <cmath>
#include <numeric>

#include "shared/pcl/clouds.hpp"

namespace plumb::describe_vfh {
namespace {

constexpr float far_up = 1e9f;  // [m] beside which a segment has no size

}  // namespace

std::optional<std::vector<float>> vfh(const Cloud& cloud, const VfhOptions& options) {
  const pcl::Oriented surface = pcl::oriented(cloud);
  if (surface.size() < 3) return std::nullopt;
  ::pcl::VFHEstimation<::pcl::PointXYZ, ::pcl::Normal, ::pcl::VFHSignature308> estimate;
  estimate.setInputCloud(surface.points);
  estimate.setInputNormals(surface.normals);
  // PCL's own centroid has a fourth coordinate of 1, which gets into distances and directions.
  estimate.setUseGivenCentroid(true);
  estimate.setCentroidToUse(centroid_of(select(cloud, surface.index)));
  estimate.setViewPoint(0, 0, options.viewpoint == Viewpoint::above ? far_up : 0);
  estimate.setFillSizeComponent(options.distances);
  estimate.setNormalizeDistance(options.distances);
  ::pcl::PointCloud<::pcl::VFHSignature308> signature;
  estimate.compute(signature);

  std::vector<float> values(std::begin(signature[0].histogram), std::end(signature[0].histogram));
  // Without a shape no pair has angles, and only the viewpoint's part is there.
  const double shape = std::accumulate(values.begin(), values.begin() + 3 * 45, 0.0);
  const double sum = std::accumulate(values.begin(), values.end(), 0.0);
  if (!(shape > 0) || !std::isfinite(sum)) return std::nullopt;
  for (auto& value : values) value = static_cast<float>(value / sum);
  return values;
}

}  // namespace plumb::describe_vfh
