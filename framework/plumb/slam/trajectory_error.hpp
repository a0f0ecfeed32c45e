#pragma once
/// How far an estimated trajectory is from a true one: absolute and relative error.

#include <vector>

#include "plumb/slam/trajectory.hpp"

namespace plumb {

/// Poses of the same moments, by index.
struct PosePairs {
  std::vector<Pose> estimate, truth;
  std::size_t size() const { return estimate.size(); }
};

/// Pairs each pose of `estimate` with the pose of `truth` whose stamp is nearest (of two as near
/// the later one), if that is less than `tolerance` [s] away; the others are left out. Stamps may
/// step back in both.
PosePairs pair_by_stamp(const Trajectory& estimate, const Trajectory& truth,
                        double tolerance = 2e-3);

/// Absolute trajectory error [m]: distances of the positions after the rigid alignment of all of
/// them.
struct AbsoluteError {
  double rmse, max;
};

/// NaN for no pairs. Source: Sturm et al. 2012, as `evo_ape -a` computes it.
AbsoluteError absolute_error(const PosePairs& pairs);

/// What its rmse is the root of the mean of: of each pair the squared distance [m^2].
std::vector<double> squared_errors(const PosePairs& pairs);

/// Relative pose error: mean difference of the motions between two poses, over a given length of
/// the true path.
struct RelativeError {
  double translation;  ///< [m]
  double rotation;     ///< [rad]
};

/// From each pose to the first one at least `over` [m] of true path later. NaN when the path is
/// shorter than that.
RelativeError relative_error(const PosePairs& pairs, double over = 10.0);

/// What that is the mean of: of each pose from which the path goes on for long enough, so of the
/// first ones.
std::vector<RelativeError> relative_errors(const PosePairs& pairs, double over = 10.0);

/// Path [m] from the first pose to each, the distances added in order.
std::vector<double> path_of(const std::vector<Pose>& poses);

}  // namespace plumb
