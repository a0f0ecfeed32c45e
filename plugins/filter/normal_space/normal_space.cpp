#include "normal_space.hpp"

#include <pcl/filters/normal_space.h>

#include <algorithm>

#include "shared/pcl/clouds.hpp"

namespace plumb::filter_normal_space {

std::vector<std::uint32_t> alike_in_normals(const Cloud& cloud, std::size_t count,
                                            std::uint32_t bins, std::uint32_t seed) {
  const pcl::Oriented surface = pcl::oriented(cloud);
  if (count >= surface.size()) return surface.index;
  if (count == 0) return {};
  ::pcl::NormalSpaceSampling<::pcl::PointXYZ, ::pcl::Normal> sampling;
  sampling.setInputCloud(surface.points);
  sampling.setNormals(surface.normals);
  sampling.setBins(bins, bins, bins);
  sampling.setSample(static_cast<unsigned>(count));
  sampling.setSeed(seed);  // in the place of PCL's, which is the time
  ::pcl::Indices chosen;
  sampling.filter(chosen);
  std::vector<std::uint32_t> kept;
  for (const auto k : chosen) kept.push_back(surface.index[static_cast<std::size_t>(k)]);
  std::sort(kept.begin(), kept.end());
  return kept;
}

}  // namespace plumb::filter_normal_space
