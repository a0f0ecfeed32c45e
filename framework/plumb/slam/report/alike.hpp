#pragma once
/// What can only be said of all variants of an input at once: errors at the same stamps, and how
/// sharp the clouds are at the same places.

#include <optional>
#include <vector>

#include "plumb/slam/experiment/measured.hpp"
#include "plumb/slam/report/written_trajectory.hpp"

namespace plumb {

/// A run of one variant, with the others on the same input in the same replicate.
struct RunBeside {
  experiment::Cell* cell = nullptr;
  std::optional<WrittenTrajectory> written = {};
};

/// Of errors against a truth (ate, rpe_translation, rpe_rotation) the sums by segment, which are
/// twenty equal parts of the true path. Where the runs' trajectories have other stamps, the errors
/// are taken anew at those that all of them have, and what else is said of these trajectories is
/// left out. Gives the largest number of a run's stamps that were left out. Throws Error: the truth
/// cannot be read.
std::size_t judge_at_same_stamps(std::vector<RunBeside>& runs);

/// Adds the number "sharpness" [m], the median ghosting (ghosting.hpp), where no truth says which
/// places are seen twice: pairs of frames that are near by some of the trajectories, as many of
/// each and the same for all. Nothing where frames are not known, or no place is seen twice.
void add_sharpness(std::vector<RunBeside>& runs);

}  // namespace plumb
