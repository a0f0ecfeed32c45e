#include "covariance_sampling.hpp"

#include <pcl/filters/covariance_sampling.h>

#include <algorithm>

#include "shared/pcl/clouds.hpp"

namespace plumb::filter_covariance_sampling {

std::vector<std::uint32_t> stable_points(const Cloud& cloud, std::size_t count) {
  const pcl::Oriented surface = pcl::oriented(cloud);
  if (count >= surface.size()) return surface.index;
  ::pcl::CovarianceSampling<::pcl::PointXYZ, ::pcl::Normal> sampling;
  sampling.setInputCloud(surface.points);
  sampling.setNormals(surface.normals);
  sampling.setNumberOfSamples(static_cast<unsigned>(count));
  ::pcl::Indices chosen;
  sampling.filter(chosen);
  std::vector<std::uint32_t> kept;
  for (const auto k : chosen) kept.push_back(surface.index[static_cast<std::size_t>(k)]);
  std::sort(kept.begin(), kept.end());
  return kept;
}

}  // namespace plumb::filter_covariance_sampling
