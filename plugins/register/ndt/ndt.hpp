#pragma once
/// Registration of points to the normal distributions of another cloud's voxels.

#include "plumb/slam/cloud.hpp"
#include "shared/pcl/registering.hpp"

namespace plumb::register_ndt {

struct NdtOptions {
  double resolution = 1;                 ///< [m] edge of a voxel
  double step_size = 0.1;                ///< [m, and rad beside it] longest step of an iteration
  double outlier_ratio = 0.55;           ///< share of points that no distribution explains
  double transformation_epsilon = 0.01;  ///< [m] converged when an iteration moves less
  std::uint32_t max_iterations = 50;

  /// As parameters of a step.
  template <class Declare>
  static void describe(Declare& is) {
    is.param("resolution", &NdtOptions::resolution)
        .unit("m")
        .range(0.01, 100)
        .doc("edge length of the voxels; each with six points or more gets a distribution");
    is.param("step_size", &NdtOptions::step_size)
        .unit("m")
        .range(1e-4, 10)
        .source("PCL, NormalDistributionsTransform")
        .doc("longest step of an iteration; rotations count in rad beside it");
    is.param("outlier_ratio", &NdtOptions::outlier_ratio)
        .range(0.01, 0.99)
        .source("PCL, NormalDistributionsTransform")
        .doc("share of the points that belong to no distribution");
    is.param("transformation_epsilon", &NdtOptions::transformation_epsilon)
        .unit("m")
        .range(1e-6, 1)
        .doc("converged when an iteration moves the pose, and points 10 m away, by less");
    is.param("max_iterations", &NdtOptions::max_iterations).range(1, 10000).doc("iterations");
  }
};

/// The motion of `source` that its points are likeliest under, if those of `target` are normally
/// distributed in each voxel, from `start` on by Newton's method with a line search. Not converged
/// where no voxel has enough points. Source: [Magnusson2009] 6; PCL's NormalDistributionsTransform.
pcl::Aligned ndt(const Cloud& target, const Cloud& source, const Pose& start,
                 const NdtOptions& options);

}  // namespace plumb::register_ndt
