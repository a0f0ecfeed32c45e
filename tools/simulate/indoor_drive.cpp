#include "simulate/indoor_drive.hpp"

#include <algorithm>
#include <numbers>

#include "plumb/data/counted.hpp"
#include "plumb/data/error.hpp"
#include "plumb/plugin/unit.hpp"
#include "simulate/drift.hpp"
#include "simulate/random.hpp"

namespace plumb::simulate {
namespace {

using Eigen::Vector2d;
using std::numbers::pi;

/// Weaving about a straight line of `length`: y(u) = amplitude sin(pi u / length) sin(waves u),
/// which begins and ends on the line and along it.
class Weave {
 public:
  Weave(double length, double amplitude)
      : length_(length),
        amplitude_(amplitude),
        bow_(pi / length),
        waves_(2 * pi * std::max(1.0, std::round(length / 6)) / length) {
    const auto steps = static_cast<std::size_t>(std::ceil(length / 0.01));
    along_.resize(steps + 1, 0);
    for (std::size_t k = 1; k <= steps; ++k) {
      const double step = length / static_cast<double>(steps);
      const double middle = (static_cast<double>(k) - 0.5) * step;
      along_[k] = along_[k - 1] + step * std::hypot(1, slope(middle));
    }
  }

  double offset(double u) const { return amplitude_ * std::sin(bow_ * u) * std::sin(waves_ * u); }
  double slope(double u) const {
    return amplitude_ * (bow_ * std::cos(bow_ * u) * std::sin(waves_ * u) +
                         waves_ * std::sin(bow_ * u) * std::cos(waves_ * u));
  }
  /// Length of the curve [m].
  double total() const { return along_.back(); }
  /// Where on the line one is after so much of the curve.
  double u_at(double way) const {
    const auto after = std::upper_bound(along_.begin() + 1, along_.end() - 1, way);
    const auto k = static_cast<double>(after - along_.begin() - 1);
    const double share = (way - *(after - 1)) / (*after - *(after - 1));
    return std::min(1.0, (k + share) / static_cast<double>(along_.size() - 1)) * length_;
  }
  /// Greatest curvature for an amplitude of 1 [1/m per m].
  double bend() const { return (bow_ + waves_) * (bow_ + waves_); }

 private:
  double length_, amplitude_, bow_, waves_;
  std::vector<double> along_;
};

/// Collects the scans that fall into one stretch of the drive after the other.
class Recorder {
 public:
  explicit Recorder(double rate) : rate_(rate) {}

  /// A stretch of `seconds`; `pose_at` says where the robot is so long after its begin.
  template <class PoseAt>
  void stretch(double seconds, bool turning, PoseAt pose_at) {
    for (;; ++tick_) {
      const double stamp = static_cast<double>(tick_) / rate_;
      if (stamp >= began_ + seconds) break;
      PlanarPose pose = pose_at(stamp - began_);
      pose.yaw = planar::wrapped(pose.yaw);
      drive_.stamps.push_back(stamp);
      drive_.poses.push_back(pose);
      drive_.turning.push_back(turning);
    }
    began_ += seconds;
  }
  IndoorDrive take() { return std::move(drive_); }

 private:
  double rate_, began_ = 0;
  std::size_t tick_ = 0;
  IndoorDrive drive_;
};

}  // namespace

IndoorDrive drive_indoors(const std::vector<Vector2d>& way, const IndoorDriveOptions& options) {
  Random random(mix(options.seed, 20));
  Recorder recorder(options.rate);
  double heading = 0;
  for (std::size_t k = 0; k + 1 < way.size(); ++k) {
    const Vector2d leg = way[k + 1] - way[k], along = leg.normalized(), left(-along.y(), along.x());
    const double begin = heading, towards = std::atan2(along.y(), along.x());
    const double turn = planar::wrapped(towards - begin);
    recorder.stretch(std::abs(turn) / options.turn_rate, true, [&](double t) {
      return PlanarPose{way[k].x(), way[k].y(), begin + std::copysign(options.turn_rate * t, turn)};
    });
    const double bend = Weave(leg.norm(), 1).bend();
    const double amplitude =
        std::min(random.uniform(0.03, 0.1), 0.5 * options.turn_rate / (options.speed * bend));
    const Weave weave(leg.norm(), random.chance(0.5) ? amplitude : -amplitude);
    recorder.stretch(weave.total() / options.speed, false, [&](double t) {
      const double u = weave.u_at(options.speed * t);
      const Vector2d at = way[k] + u * along + weave.offset(u) * left;
      return PlanarPose{at.x(), at.y(), towards + std::atan(weave.slope(u))};
    });
    heading = towards;
  }
  return recorder.take();
}

double way_length(const std::vector<PlanarPose>& poses) {
  double sum = 0;
  for (std::size_t k = 1; k < poses.size(); ++k)
    sum += std::hypot(poses[k].x - poses[k - 1].x, poses[k].y - poses[k - 1].y);
  return sum;
}

std::vector<PlanarPose> wheel_odometry(const std::vector<PlanarPose>& truth, double drift,
                                       std::uint64_t seed) {
  if (drift <= 0) return truth;
  Random fixed(mix(seed, 21));
  const double way_scale = 0.01 * fixed.gauss(), turn_scale = 0.02 * fixed.gauss();
  const double bias = 0.002 * fixed.gauss();  // [rad/m]
  const auto with_errors = [&](double factor) {
    Random random(mix(seed, 22));
    std::vector<PlanarPose> made{truth.front()};
    for (std::size_t k = 1; k < truth.size(); ++k) {
      const PlanarPose &from = truth[k - 1], &to = truth[k];
      const double dx = to.x - from.x, dy = to.y - from.y,
                   turn = planar::wrapped(to.yaw - from.yaw);
      const double way = std::hypot(dx, dy);
      const double stretched =
          1 + factor * (way_scale + 0.005 * random.gauss() / std::sqrt(std::max(way, 1e-3)));
      const double turned = turn + factor * (turn_scale * turn + bias * way +
                                             0.005 * std::sqrt(way) * random.gauss() +
                                             0.01 * std::sqrt(std::abs(turn)) * random.gauss());
      // The step as the robot sees it, turned into the heading that the wheels believe.
      const double believed = made.back().yaw - from.yaw + 0.5 * (turned - turn);
      const double c = std::cos(believed), s = std::sin(believed);
      made.push_back({made.back().x + stretched * (c * dx - s * dy),
                      made.back().y + stretched * (s * dx + c * dy),
                      planar::wrapped(made.back().yaw + turned)});
    }
    return made;
  };
  return with_errors(factor_that_reaches(drift, [&](double factor) {
    const std::vector<PlanarPose> made = with_errors(factor);
    double greatest = 0;
    for (std::size_t k = 0; k < truth.size(); ++k)
      greatest = std::max(greatest, std::hypot(made[k].x - truth[k].x, made[k].y - truth[k].y));
    return greatest;
  }));
}

std::vector<char> lost_scans(const IndoorDrive& drive, const LostScans& options) {
  constexpr double margin = 10;  // [s]
  std::vector<char> lost(drive.size(), 0);
  for (std::size_t k = 1; k < drive.size(); ++k)
    lost[k] =
        drive.turning[k] && static_cast<double>(unit(mix(options.seed, 23, k))) < options.in_turns;
  if (options.stretches == 0) return lost;
  const double part = (drive.stamps.back() - 2 * margin) / static_cast<double>(options.stretches);
  if (part < options.stretch + margin)
    throw Error("scene: the drive takes " + written(drive.stamps.back(), Quantity::time) +
                ", too short for " + counted(options.stretches, "stretches") + " of " +
                written(options.stretch, Quantity::time) +
                " without scans; ask for fewer or shorter ones");
  Random random(mix(options.seed, 24));
  for (std::int64_t n = 0; n < options.stretches; ++n) {
    const double begin = margin + part * static_cast<double>(n) +
                         random.uniform(0, part - options.stretch - 0.5 * margin);
    for (std::size_t k = 1; k < drive.size(); ++k)
      if (drive.stamps[k] >= begin && drive.stamps[k] < begin + options.stretch) lost[k] = 1;
  }
  return lost;
}

}  // namespace plumb::simulate
