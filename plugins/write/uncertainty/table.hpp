#pragma once
/// How well each frame's pose is known, as a table.

#include <string>
#include <vector>

#include "plumb/slam/graph.hpp"
#include "plumb/slam/segment.hpp"
#include "plumb/slam/trajectory.hpp"

namespace plumb::write_uncertainty {

/// Covariance of a pose: of the position [m^2] and of the rotation vector [rad^2], both in world
/// axes.
struct PoseUncertainty {
  Eigen::Matrix3d position = Eigen::Matrix3d::Zero(), rotation = Eigen::Matrix3d::Zero();
};

/// One for each segment from the absolute poses that solve.pose_graph gives; zero for those that it
/// holds fixed. Throws Error for a segment that does not exist.
std::vector<PoseUncertainty> uncertainty_of(const Constraints& constraints, std::size_t segments);

/// Of each frame: between the middle frames of two segments in proportion to the frames, before the
/// first and after the last theirs. A first segment that is held fixed stands for the first frame,
/// which has 0 alone.
std::vector<PoseUncertainty> of_frames(const std::vector<PoseUncertainty>& segments,
                                       const std::vector<FrameRange>& ranges, std::size_t frames);

/// CSV: a line of names, then for each frame stamp [s], x y z [m], the six numbers of the
/// position's covariance (xx xy xz yy yz zz) [m^2], and the standard deviations about the frame's
/// x, y and z [rad].
std::string uncertainty_table(const Trajectory& trajectory,
                              const std::vector<PoseUncertainty>& frames);

}  // namespace plumb::write_uncertainty
