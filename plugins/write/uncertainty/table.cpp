#include "table.hpp"

#include <cmath>
#include <cstdio>

#include "plumb/data/counted.hpp"
#include "plumb/data/error.hpp"
#include "plumb/slam/geometry/symmetric.hpp"

namespace plumb::write_uncertainty {

std::vector<PoseUncertainty> uncertainty_of(const Constraints& constraints, std::size_t segments) {
  std::vector<PoseUncertainty> of(segments);
  for (const AbsolutePose& pose : constraints.absolute) {
    if (pose.i >= segments)
      throw Error("the uncertainty names segment " + std::to_string(pose.i) + ", but got " +
                  counted(segments, "segments") + ": wire ranges of the segments that were solved");
    const Matrix6d covariance = inverse_of_symmetric(pose.information);
    const Eigen::Matrix3d R = pose.T_world_i.matrix();
    of[pose.i].position = R * covariance.topLeftCorner<3, 3>() * R.transpose();
    of[pose.i].rotation = 4 * R * covariance.bottomRightCorner<3, 3>() *
                          R.transpose();  // information counts q.vec, half the angle
  }
  return of;
}

std::vector<PoseUncertainty> of_frames(const std::vector<PoseUncertainty>& segments,
                                       const std::vector<FrameRange>& ranges, std::size_t frames) {
  std::vector<PoseUncertainty> of(frames);
  // Where the first segment is held fixed the first frame is what all poses are relative to.
  const bool from_first =
      segments.size() > 1 && segments[0].position.isZero(0) && segments[0].rotation.isZero(0);
  const auto middle = [&](std::size_t s) -> std::size_t {
    return s == 0 && from_first ? 0 : ranges[s].middle();
  };
  std::size_t s = 0;
  for (std::size_t f = 0; f < frames && !ranges.empty(); ++f) {
    while (s + 1 < ranges.size() && middle(s + 1) <= f) ++s;
    if (f <= middle(s) || s + 1 == ranges.size()) {
      of[f] = segments[s];
      continue;
    }
    const double share =
        static_cast<double>(f - middle(s)) / static_cast<double>(middle(s + 1) - middle(s));
    of[f] = {(1 - share) * segments[s].position + share * segments[s + 1].position,
             (1 - share) * segments[s].rotation + share * segments[s + 1].rotation};
  }
  return of;
}

std::string uncertainty_table(const Trajectory& trajectory,
                              const std::vector<PoseUncertainty>& frames) {
  std::string text =
      "stamp,x,y,z,cov_xx,cov_xy,cov_xz,cov_yy,cov_yz,cov_zz,sigma_roll,sigma_pitch,sigma_yaw\n";
  for (std::size_t k = 0; k < trajectory.size(); ++k) {
    const auto& p = trajectory.T_world_frame[k].translation;
    const auto& c = frames[k].position;
    const Eigen::Matrix3d R = trajectory.T_world_frame[k].matrix(),
                          r = R.transpose() * frames[k].rotation * R;
    char line[400];
    std::snprintf(line, sizeof line,
                  "%.9f,%.6f,%.6f,%.6f,%.6g,%.6g,%.6g,%.6g,%.6g,%.6g,%.6g,%.6g,%.6g\n",
                  trajectory.stamps[k], p.x(), p.y(), p.z(), c(0, 0), c(0, 1), c(0, 2), c(1, 1),
                  c(1, 2), c(2, 2), std::sqrt(r(0, 0)), std::sqrt(r(1, 1)), std::sqrt(r(2, 2)));
    text += line;
  }
  return text;
}

}  // namespace plumb::write_uncertainty
