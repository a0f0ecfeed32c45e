#include "sequence_folder.hpp"

namespace plumb::source_sequence {

void bring_to_frame(Cloud& cloud, const Pose& T_world_frame) {
  const Pose T_frame_world = T_world_frame.inverse();
  const Eigen::Matrix3d r = T_frame_world.matrix();
  const Eigen::Vector3d& t = T_frame_world.translation;
  for (std::size_t k = 0; k < cloud.size(); ++k) {
    const Eigen::Vector3f p = (r * cloud.point(k).cast<double>() + t).cast<float>();
    cloud.x[k] = p.x();
    cloud.y[k] = p.y();
    cloud.z[k] = p.z();
  }
  if (!cloud.has_normals()) return;
  for (std::size_t k = 0; k < cloud.size(); ++k) {
    const Eigen::Vector3f n = (r * cloud.normal(k).cast<double>()).cast<float>();
    cloud.nx[k] = n.x();
    cloud.ny[k] = n.y();
    cloud.nz[k] = n.z();
  }
}

}  // namespace plumb::source_sequence
