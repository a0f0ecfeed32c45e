#include "iss.hpp"

#include <pcl/keypoints/iss_3d.h>

#include "shared/pcl/clouds.hpp"

/// In the place of PCL 1.13's own, which may have a third eigenvalue that rounding made negative:
/// its caller then passes the point over before it has stored the point's numbers and compares what
/// the memory held before. A scatter of zeros, as of a point with too few neighbours, is no
/// keypoint and stored.
template <>
void pcl::ISSKeypoint3D<pcl::PointXYZ, pcl::PointXYZ, pcl::Normal>::getScatterMatrix(
    const int& index, Eigen::Matrix3d& scatter) {
  constexpr double flat = 1e-9;
  scatter.setZero();
  pcl::Indices neighbours;
  std::vector<float> squared_distances;
  searchForNeighbors(index, salient_radius_, neighbours, squared_distances);
  if (static_cast<int>(neighbours.size()) < min_neighbors_) return;
  const Eigen::Vector3d centre = (*input_)[index].getVector3fMap().cast<double>();
  for (const auto k : neighbours) {
    const Eigen::Vector3d off = (*input_)[k].getVector3fMap().cast<double>() - centre;
    scatter += off * off.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(scatter, Eigen::EigenvaluesOnly);
  if (!(solver.eigenvalues()[0] > flat * solver.eigenvalues()[2])) scatter.setZero();
}

namespace plumb::keypoints_iss {

std::vector<std::uint32_t> iss(const Cloud& cloud, const IssOptions& options) {
  if (cloud.empty()) return {};
  ::pcl::ISSKeypoint3D<::pcl::PointXYZ, ::pcl::PointXYZ, ::pcl::Normal> detector(
      options.salient_radius);
  detector.setInputCloud(pcl::points_of(cloud));
  detector.setNonMaxRadius(options.non_max_radius);
  detector.setThreshold21(options.gamma_21);
  detector.setThreshold32(options.gamma_32);
  detector.setMinNeighbors(static_cast<int>(options.min_neighbours));
  detector.setNumberOfThreads(1);
  pcl::Points found;
  detector.compute(found);
  const auto& kept = detector.getKeypointsIndices()->indices;
  return {kept.begin(), kept.end()};
}

}  // namespace plumb::keypoints_iss
