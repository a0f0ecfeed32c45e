#include "motion_vectors.hpp"

#include "plumb/data/error.hpp"

namespace plumb::prune_kmeans {

std::vector<Vector6d> displacements(const Matches& matches, const Pose& T_i_j) {
  const Eigen::Matrix3d r = T_i_j.matrix();
  std::vector<Vector6d> vectors(matches.size(), Vector6d::Zero());
  for (std::size_t k = 0; k < matches.size(); ++k)
    vectors[k].head<3>() =
        matches.p[k].cast<double>() - (r * matches.q[k].cast<double>() + T_i_j.translation);
  return vectors;
}

std::vector<Vector6d> motions(const Matches& matches, const Pose& T_i_j, double lever) {
  if (matches.normal_p.size() != matches.size() || matches.normal_q.size() != matches.size())
    throw Error(
        "the pairs have no normals, which 'vector: motion' needs: put estimate.normals "
        "before the step that describes the points, or take 'vector: displacement'");
  auto vectors = displacements(matches, T_i_j);
  for (std::size_t k = 0; k < matches.size(); ++k) {
    const Eigen::Vector3d to = matches.normal_p[k].cast<double>();
    const Eigen::Vector3d from = T_i_j.rotation * matches.normal_q[k].cast<double>();
    vectors[k].tail<3>() = lever * log_rotation(Eigen::Quaterniond::FromTwoVectors(from, to));
  }
  return vectors;
}

}  // namespace plumb::prune_kmeans
