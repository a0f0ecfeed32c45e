#include "radius_outlier.hpp"

#include <pcl/filters/radius_outlier_removal.h>

#include "shared/pcl/clouds.hpp"

namespace plumb::filter_radius_outlier {

std::vector<std::uint32_t> not_alone(const Cloud& cloud, double radius,
                                     std::uint32_t min_neighbours) {
  if (cloud.empty()) return {};
  ::pcl::RadiusOutlierRemoval<::pcl::PointXYZ> remove;
  remove.setInputCloud(pcl::points_of(cloud));
  remove.setRadiusSearch(radius);
  remove.setMinNeighborsInRadius(static_cast<int>(min_neighbours));
  ::pcl::Indices kept;
  remove.filter(kept);
  return {kept.begin(), kept.end()};
}

}  // namespace plumb::filter_radius_outlier
