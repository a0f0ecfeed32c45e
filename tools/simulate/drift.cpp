#include "simulate/drift.hpp"

#include <algorithm>
#include <cmath>

#include "plumb/data/error.hpp"
#include "plumb/data/short_number.hpp"
#include "simulate/random.hpp"

namespace plumb::simulate {
namespace {

using Eigen::Vector3d;

constexpr double memory = 100;  // of the errors [m]

/// The errors of the step that leads to a frame, before scaling.
struct StepError {
  Vector3d turn;  ///< [rad]
  double scale;   ///< share of the step's length
};

std::vector<StepError> slow_errors(const Trajectory& truth, std::uint64_t seed) {
  Random random(mix(seed, 0x6472696674));
  const Vector3d turn_rate(0.5e-4, 0.5e-4, 1e-4);  // roll, pitch, yaw [rad/m]
  constexpr double scale_rate = 3e-3;
  const auto four = [&random] {
    return Eigen::Vector4d(random.gauss(), random.gauss(), random.gauss(), random.gauss());
  };
  Eigen::Vector4d state = four();
  std::vector<StepError> errors{{Vector3d::Zero(), 0}};
  for (std::size_t k = 1; k < truth.size(); ++k) {
    const double step =
        (truth.T_world_frame[k].translation - truth.T_world_frame[k - 1].translation).norm();
    const double keep = std::exp(-step / memory);
    state = keep * state + std::sqrt(1 - keep * keep) * four();
    errors.push_back({step * turn_rate.cwiseProduct(state.head<3>()), scale_rate * state[3]});
  }
  return errors;
}

Trajectory with_errors(const Trajectory& truth, const std::vector<StepError>& errors,
                       double factor) {
  Trajectory result{truth.stamps, {truth.T_world_frame.front()}};
  result.T_world_frame.reserve(truth.size());
  for (std::size_t k = 1; k < truth.size(); ++k) {
    Pose step = truth.T_world_frame[k - 1].inverse() * truth.T_world_frame[k];
    step.translation *= 1 + factor * errors[k].scale;
    step.rotation = step.rotation * exp_rotation(factor * errors[k].turn);
    result.T_world_frame.push_back(result.T_world_frame.back() * step);
  }
  return result;
}

/// Travelled distance that grows by a hair even at rest, so that errors made at rest have a place.
std::vector<double> places(const Trajectory& path) {
  std::vector<double> s = travelled(path);
  for (std::size_t k = 0; k < s.size(); ++k) s[k] += 1e-6 * static_cast<double>(k);
  return s;
}

/// A share (0 to 1) of a small motion.
Pose part(const Pose& motion, double share) {
  if (share >= 1) return motion;
  return {exp_rotation(share * log_rotation(motion.rotation)), share * motion.translation};
}

}  // namespace

double drift_of(const Trajectory& odometry, const Trajectory& truth) {
  const Pose T_truth_odometry =
      truth.T_world_frame.front() * odometry.T_world_frame.front().inverse();
  double greatest = 0;
  for (std::size_t k = 0; k < truth.size(); ++k)
    greatest = std::max(greatest, (T_truth_odometry * odometry.T_world_frame[k].translation -
                                   truth.T_world_frame[k].translation)
                                      .norm());
  return greatest;
}

double factor_that_reaches(double drift, const std::function<double(double)>& reached) {
  double low = 0, high = 1;
  for (int k = 0; reached(high) < drift; ++k) {
    if (k == 60)
      throw Error("a drift of " + std::to_string(drift) +
                  " m cannot be reached on this path; ask for less");
    low = high;
    high *= 2;
  }
  for (int k = 0; k < 40; ++k) {
    const double middle = 0.5 * (low + high);
    (reached(middle) < drift ? low : high) = middle;
  }
  return high;
}

Trajectory drifted(const Trajectory& truth, double drift, std::uint64_t seed) {
  if (drift <= 0 || truth.size() < 2) return truth;
  const std::vector<StepError> errors = slow_errors(truth, seed);
  return with_errors(truth, errors, factor_that_reaches(drift, [&](double factor) {
                       return drift_of(with_errors(truth, errors, factor), truth);
                     }));
}

Trajectory transplanted(const Trajectory& truth, const Trajectory& odometry,
                        const Trajectory& odometry_truth) {
  if (odometry.size() != odometry_truth.size())
    throw Error("drift to transplant: the odometry has " + std::to_string(odometry.size()) +
                " poses and its truth " + std::to_string(odometry_truth.size()) +
                "; give two trajectories of the same frames");
  const std::vector<double> source = places(odometry_truth), target = places(truth);
  if (!(source.back() > 1))
    throw Error("drift to transplant: its path is shorter than 1 m; give one that moves");

  std::vector<Pose> errors;  // of the step from k to k + 1, in the later frame
  for (std::size_t k = 0; k + 1 < source.size(); ++k) {
    const Pose right =
        odometry_truth.T_world_frame[k].inverse() * odometry_truth.T_world_frame[k + 1];
    const Pose made = odometry.T_world_frame[k].inverse() * odometry.T_world_frame[k + 1];
    errors.push_back(right.inverse() * made);
  }
  Trajectory result{truth.stamps, {truth.T_world_frame.front()}};
  result.T_world_frame.reserve(truth.size());
  std::size_t k = 0;  // the source's step under way
  double shift = 0;   // where the source's path began this time
  for (std::size_t n = 0; n + 1 < target.size(); ++n) {
    Pose step = truth.T_world_frame[n].inverse() * truth.T_world_frame[n + 1];
    for (double from = target[n]; from < target[n + 1];) {
      const double end = shift + source[k + 1], to = std::min(end, target[n + 1]);
      step = step * part(errors[k], (to - from) / (source[k + 1] - source[k]));
      from = to;
      if (to < end) break;
      if (++k == errors.size()) k = 0, shift = end;
    }
    result.T_world_frame.push_back(result.T_world_frame.back() * step);
  }
  return result;
}

}  // namespace plumb::simulate
