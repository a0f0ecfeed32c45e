#include "harris3d.hpp"

#include <pcl/keypoints/harris_3d.h>

#include "shared/pcl/clouds.hpp"

namespace plumb::keypoints_harris3d {

std::vector<std::uint32_t> harris3d(const Cloud& cloud, const HarrisOptions& options) {
  const pcl::Oriented surface = pcl::oriented(cloud);
  if (surface.size() == 0) return {};
  using Detector = ::pcl::HarrisKeypoint3D<::pcl::PointXYZ, ::pcl::PointXYZI, ::pcl::Normal>;
  Detector detector(options.response == Response::harris ? Detector::HARRIS : Detector::TOMASI,
                    static_cast<float>(options.radius), static_cast<float>(options.threshold));
  detector.setInputCloud(surface.points);
  detector.setNormals(surface.normals);
  detector.setRefine(false);  // else they are no points of the cloud
  detector.setNonMaxSupression(true);
  detector.setNumberOfThreads(1);
  ::pcl::PointCloud<::pcl::PointXYZI> found;
  detector.compute(found);
  std::vector<std::uint32_t> kept;
  for (const auto k : detector.getKeypointsIndices()->indices)
    kept.push_back(surface.index[static_cast<std::size_t>(k)]);
  return kept;
}

}  // namespace plumb::keypoints_harris3d
