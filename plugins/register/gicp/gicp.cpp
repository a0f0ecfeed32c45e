#include "gicp.hpp"

#include <pcl/registration/gicp.h>

#include <algorithm>

#include "shared/pcl/clouds.hpp"

namespace plumb::register_gicp {
namespace {

using Gicp = ::pcl::GeneralizedIterativeClosestPoint<::pcl::PointXYZ, ::pcl::PointXYZ>;

constexpr double along_normal = 1e-3;  // PCL's gicp_epsilon

Gicp::MatricesVectorPtr covariances_of(const Cloud& cloud) {
  Gicp::MatricesVectorPtr result(new Gicp::MatricesVector);
  result->reserve(cloud.size());
  for (std::size_t k = 0; k < cloud.size(); ++k) {
    const Eigen::Vector3d n = cloud.normal(k).cast<double>();
    result->push_back(Eigen::Matrix3d::Identity() - (1 - along_normal) * n * n.transpose());
  }
  return result;
}

bool has_enough(const Cloud& cloud, const GicpOptions& options) {
  return cloud.size() >= (cloud.has_normals() ? 4u : std::max(options.neighbours, 4u));
}

}  // namespace

pcl::Aligned gicp(const Cloud& target, const Cloud& source, const Pose& start,
                  double max_correspondence_distance, const GicpOptions& options) {
  if (!has_enough(target, options) || !has_enough(source, options)) return {start, 0, false};
  Gicp registration;
  registration.setMaxCorrespondenceDistance(max_correspondence_distance);
  registration.setCorrespondenceRandomness(static_cast<int>(options.neighbours));
  registration.setTransformationEpsilon(options.transformation_epsilon);
  registration.setRotationEpsilon(options.rotation_epsilon);
  registration.setMaximumIterations(static_cast<int>(options.max_iterations));
  registration.setInputTarget(pcl::points_of(target));
  registration.setInputSource(pcl::points_of(source));
  if (target.has_normals()) registration.setTargetCovariances(covariances_of(target));
  if (source.has_normals()) registration.setSourceCovariances(covariances_of(source));
  pcl::Points moved;
  registration.align(moved, pcl::matrix_of(start));
  return pcl::aligned_by(registration.getFinalTransformation(), registration.nr_iterations_,
                         registration.hasConverged());
}

}  // namespace plumb::register_gicp
