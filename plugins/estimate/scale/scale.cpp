#include "scale.hpp"

#include <algorithm>

namespace plumb::estimate_scale {

double usual_speed(const Trajectory& trajectory) {
  std::vector<double> speeds;
  for (std::size_t k = 1; k < trajectory.size(); ++k) {
    const double time = trajectory.stamps[k] - trajectory.stamps[k - 1];
    const double path =
        (trajectory.T_world_frame[k].translation - trajectory.T_world_frame[k - 1].translation)
            .norm();
    if (time > 0) speeds.push_back(path / time);
  }
  if (speeds.empty()) return 0;
  std::ranges::sort(speeds);
  const double fast = speeds[speeds.size() * 9 / 10];
  const auto moving = std::ranges::upper_bound(speeds, 0.1 * fast);
  const auto count = speeds.end() - moving;
  return count > 0 ? *(moving + count / 2) : 0;
}

double scale_at(double speed, double full_speed, double min_factor) {
  return speed > 0 ? std::clamp(speed / full_speed, min_factor, 1.0) : 1.0;
}

}  // namespace plumb::estimate_scale
