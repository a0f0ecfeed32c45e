#pragma once
/// How well an odometry knows the motion from each segment to the next.

#include <optional>
#include <vector>

#include "plumb/slam/graph.hpp"

namespace plumb::constrain_odometry {

/// Standard deviations of a motion: what it has at rest, and what grows with the path and the turn.
/// Errors of a step are taken as proportional to the step, not to its root: the errors of lidar
/// odometries are mostly slow (a tilted sensor, a wrong scale).
struct MotionNoise {
  double translation_per_metre = 0.03;     ///< [m/m]
  double rotation_per_metre = 0.1 * deg;   ///< [rad/m]
  double rotation_per_turn = 0.02;         ///< [rad/rad]
  double min_translation_sigma = 0.02;     ///< [m]
  double min_rotation_sigma = 0.05 * deg;  ///< [rad]

  /// As parameters of a step.
  template <class Declare>
  static void describe(Declare& is) {
    is.param("translation_per_metre", &MotionNoise::translation_per_metre)
        .unit("%")
        .range(1e-6, 10)
        .doc("standard deviation of the translation, as a share of its length");
    is.param("rotation_per_metre", &MotionNoise::rotation_per_metre)
        .unit("rad/m")
        .range(1e-6 * deg, 360 * deg)
        .doc("standard deviation of the rotation for each metre of translation");
    is.param("rotation_per_turn", &MotionNoise::rotation_per_turn)
        .unit("%")
        .range(0, 10)
        .doc("standard deviation of the rotation, as a share of the rotation");
    is.param("min_translation_sigma", &MotionNoise::min_translation_sigma)
        .unit("m")
        .range(1e-6, 1e3)
        .doc("standard deviation of the translation at rest");
    is.param("min_rotation_sigma", &MotionNoise::min_rotation_sigma)
        .unit("rad")
        .range(1e-6 * deg, 360 * deg)
        .doc("standard deviation of the rotation at rest");
  }
};

/// The motion from segment k to k + 1 with the standard deviations of x, y, z [m] and of the
/// rotation vector [rad], all in k + 1's axes.
struct Motion6 {
  Pose T_k_next;
  Vector6d sigma = Vector6d::Zero();
};

struct OdometryNoise {
  std::vector<Motion6> motions;  ///< one less than there are poses
  Vector6d factor =
      Vector6d::Ones();  ///< what the expected deviations were multiplied by, axis by axis
  std::vector<std::uint32_t>
      outliers;  ///< k: the motion from k to k + 1 contradicts the registrations
};

/// Deviations as `noise` expects them. With `registered` (where registrations of the same segments
/// have put them), the expected ones are scaled axis by axis to what the odometry's motions differ
/// from the registered ones by (median, as for normal errors; at most `max_factor` up or down), and
/// motions that differ by more than `max_deviation` such deviations get so wide that they hold
/// nothing but what the difference allows.
OdometryNoise odometry_noise(const Poses& odometry, const Poses* registered,
                             const MotionNoise& noise, double max_factor, double max_deviation);

/// Constraints of a pose graph from these.
Constraints constraints_from(const std::vector<Motion6>& motions);

}  // namespace plumb::constrain_odometry
