#include "ndt.hpp"

#include <pcl/registration/ndt.h>

#include <cmath>

#include "shared/pcl/clouds.hpp"

namespace plumb::register_ndt {
namespace {

constexpr double lever = 10;  // [m] at which a turn is as much as a move

}  // namespace

pcl::Aligned ndt(const Cloud& target, const Cloud& source, const Pose& start,
                 const NdtOptions& options) {
  if (target.empty() || source.empty()) return {start, 0, false};
  ::pcl::NormalDistributionsTransform<::pcl::PointXYZ, ::pcl::PointXYZ> registration;
  registration.setResolution(static_cast<float>(options.resolution));
  registration.setStepSize(options.step_size);
  registration.setOulierRatio(options.outlier_ratio);
  // PCL compares the square of the last move, and the cosine of the last turn.
  registration.setTransformationEpsilon(std::pow(options.transformation_epsilon, 2));
  registration.setTransformationRotationEpsilon(std::cos(options.transformation_epsilon / lever));
  registration.setMaximumIterations(static_cast<int>(options.max_iterations));
  registration.setInputSource(pcl::points_of(source));
  registration.setInputTarget(pcl::points_of(target));
  pcl::Points moved;
  registration.align(moved, pcl::matrix_of(start));
  return pcl::aligned_by(registration.getFinalTransformation(), registration.getFinalNumIteration(),
                         registration.hasConverged());
}

}  // namespace plumb::register_ndt
