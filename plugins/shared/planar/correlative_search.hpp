#pragma once
/// The pose in a window that registers points best to a likelihood field: exhaustive search of a
/// grid of poses by branch and bound. Sources: [Olson2009], [Hess2016].

#include <optional>
#include <vector>

#include "shared/planar/likelihood_field.hpp"
#include "shared/planar/planar_pose.hpp"

namespace plumb::planar {

/// A prior on the pose: a score is lowered by up to `weight`, by half of it at `translation_sigma`
/// [m] or at `rotation_sigma` [rad] from `pose`. Where the points do not constrain the pose, as
/// along a corridor, the prior decides; where they do by more than `weight`, it has no influence.
struct Prior {
  PlanarPose pose;
  double weight = 0, translation_sigma = 0.05, rotation_sigma = 0.05;

  /// What it takes from the score of `other`.
  double lost(const PlanarPose& other) const {
    const double dx = (other.x - pose.x) / translation_sigma,
                 dy = (other.y - pose.y) / translation_sigma;
    const double turn = wrapped(other.yaw - pose.yaw) / rotation_sigma;
    const double square = dx * dx + dy * dy + turn * turn;
    return weight * square / (1 + square);
  }
};

/// Where to look: `centre` +- the half widths [m], [rad].
struct SearchWindow {
  PlanarPose centre;
  double x = 0.5, y = 0.5, yaw = 0.3;
  Prior prior = {};
};

/// Poses that are not looked at: those nearer than `distance` [m] and `yaw` [rad] to `pose`.
struct Excluded {
  PlanarPose pose;
  double distance = 0, yaw = 0;
};

struct Peak {
  PlanarPose pose;   ///< of the points in the field
  double score = 0;  ///< mean value of the points' cells, 0 to 1, less what `prior` takes
};

/// The best pose of the window's grid (one cell in x and y, `yaw_step` [rad] in yaw) whose score is
/// above `least`; none if there is none. Exact: the same as trying each. Of equal ones the first in
/// the order of yaw, y, x counts.
std::optional<Peak> best_pose(const LikelihoodField& field, const std::vector<float>& x,
                              const std::vector<float>& y, const SearchWindow& window,
                              double yaw_step, double least,
                              const std::optional<Excluded>& excluded = {});

/// Mean value of the points' cells under a pose, 0 to 1.
double score_of(const LikelihoodField& field, const std::vector<float>& x,
                const std::vector<float>& y, const PlanarPose& pose);

/// `peak` moved by less than half a cell, to the tops of the parabolas through the scores of its
/// neighbours in x, y and yaw, less what `prior` takes.
PlanarPose between_cells(const LikelihoodField& field, const std::vector<float>& x,
                         const std::vector<float>& y, const PlanarPose& peak, double yaw_step,
                         const Prior& prior = {});

/// The step of yaw [rad] that moves nine of ten of the points by at most a cell.
double yaw_step_for(const std::vector<float>& x, const std::vector<float>& y, double resolution);

}  // namespace plumb::planar
