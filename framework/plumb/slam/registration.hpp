#pragma once
/// How one cloud was registered to another: the result of a registration, one per edge.

#include <cmath>

#include "plumb/slam/values.hpp"

namespace plumb {

/// The pose that a registration found for an edge, and how good it is.
struct Registration {
  Pose T_i_j;                               ///< maps j's coordinates to i's
  Matrix6d information = Matrix6d::Zero();  ///< [1/m, 1/rad, squared] translation first, then
                                            ///< rotation; zero: nothing known
  std::uint32_t iterations = 0;             ///< of the search for the nearest pairs
  std::uint32_t pairs = 0;                  ///< in the last iteration
  float mae = 0;                            ///< mean distance of those pairs [m]
  float overlap = 0;                        ///< share of j's points that have a pair, 0 to 1
  bool accepted = false;                    ///< whether it passed the step's own tests
};

/// A constraint of an edge as pose graphs take it. Their information counts a rotation by its
/// q.vec, half the angle, where `information` counts it by the angle [rad].
inline RelativePose constraint_of(const Edge& edge, const Pose& T_i_j,
                                  const Matrix6d& information) {
  Vector6d scale;
  scale << 1, 1, 1, 2, 2, 2;
  return {edge.i, edge.j, T_i_j, scale.asDiagonal() * information * scale.asDiagonal()};
}

/// Whether a motion stays in the plane z = 0: no z, roll or pitch, but for rounding.
inline bool in_plane(const Pose& motion) {
  constexpr double rounding = 1e-9;
  return std::abs(motion.translation.z()) < rounding && std::abs(motion.rotation.x()) < rounding &&
         std::abs(motion.rotation.y()) < rounding;
}

template <class Archive, class T>
requires std::is_same_v<std::remove_const_t<T>, Registration>
void fields(Archive& a, T& r) {
  a(r.T_i_j, r.information, r.iterations, r.pairs, r.mae, r.overlap, r.accepted);
}

}  // namespace plumb
