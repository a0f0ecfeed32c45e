#pragma once
/// The two error functions of a relative pose; as costs of Ceres they stand in costs.hpp.

namespace plumb::solve_pose_graph {

/// How a relative pose Z = T_i_j with information Omega is compared with T_i^-1 T_j.
enum class ConstraintError {
  g2o,  ///< e'Omega e with e = [t; q.vec] of Z^-1 T_i^-1 T_j, q.w >= 0. Source: g2o, EDGE_SE3:QUAT
  chordal  ///< tau |t_j - t_i - R_i t_Z|^2 + kappa |R_j - R_i R_Z|_F^2. Source: [Rosen2019]
           ///< (SE-Sync)
};

}  // namespace plumb::solve_pose_graph
