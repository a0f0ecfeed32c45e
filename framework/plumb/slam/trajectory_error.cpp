#include "plumb/slam/trajectory_error.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "plumb/slam/geometry/alignment.hpp"

namespace plumb {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

/// Summed from the left, so that paths of round lengths come out the same in every program.
double length(const Eigen::Vector3d& v) {
  return std::sqrt(v.x() * v.x() + v.y() * v.y() + v.z() * v.z());
}

std::vector<Eigen::Vector3d> positions(const std::vector<Pose>& poses) {
  std::vector<Eigen::Vector3d> result;
  result.reserve(poses.size());
  for (const auto& pose : poses) result.push_back(pose.translation);
  return result;
}

}  // namespace

PosePairs pair_by_stamp(const Trajectory& estimate, const Trajectory& truth, double tolerance) {
  PosePairs pairs;
  if (truth.stamps.empty()) return pairs;
  std::vector<std::size_t> order(truth.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, {}, [&](std::size_t k) { return truth.stamps[k]; });
  std::vector<double> stamps(truth.size());
  for (std::size_t k = 0; k < order.size(); ++k) stamps[k] = truth.stamps[order[k]];
  for (std::size_t k = 0; k < estimate.size(); ++k) {
    const double stamp = estimate.stamps[k];
    auto near = static_cast<std::size_t>(std::ranges::lower_bound(stamps, stamp) - stamps.begin());
    near = std::min(near, stamps.size() - 1);
    if (near > 0 && std::abs(stamps[near - 1] - stamp) < std::abs(stamps[near] - stamp)) --near;
    if (!(std::abs(stamps[near] - stamp) < tolerance)) continue;
    pairs.estimate.push_back(estimate.T_world_frame[k]);
    pairs.truth.push_back(truth.T_world_frame[order[near]]);
  }
  return pairs;
}

std::vector<double> squared_errors(const PosePairs& pairs) {
  const auto estimate = positions(pairs.estimate), truth = positions(pairs.truth);
  const Pose T_truth_estimate = align(estimate, truth);
  std::vector<double> squared;
  for (std::size_t k = 0; k < estimate.size(); ++k)
    squared.push_back((T_truth_estimate * estimate[k] - truth[k]).squaredNorm());
  return squared;
}

AbsoluteError absolute_error(const PosePairs& pairs) {
  if (pairs.size() == 0) return {unknown, unknown};
  double sum = 0, most = 0;
  for (const double squared : squared_errors(pairs)) {
    sum += squared;
    most = std::max(most, squared);
  }
  return {std::sqrt(sum / static_cast<double>(pairs.size())), std::sqrt(most)};
}

std::vector<RelativeError> relative_errors(const PosePairs& pairs, double over) {
  const auto path = path_of(pairs.truth);
  std::vector<RelativeError> errors;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const auto j = std::ranges::lower_bound(path, path[i] + over) - path.begin();
    if (j == std::ssize(path)) break;
    const Pose truth = pairs.truth[i].inverse() * pairs.truth[j];
    const Pose estimate = pairs.estimate[i].inverse() * pairs.estimate[j];
    const Pose error = truth.inverse() * estimate;
    errors.push_back({error.translation.norm(), angle(error)});
  }
  return errors;
}

RelativeError relative_error(const PosePairs& pairs, double over) {
  const auto errors = relative_errors(pairs, over);
  if (errors.empty()) return {unknown, unknown};
  RelativeError sum{0, 0};
  for (const RelativeError& error : errors) {
    sum.translation += error.translation;
    sum.rotation += error.rotation;
  }
  const double n = static_cast<double>(errors.size());
  return {sum.translation / n, sum.rotation / n};
}

std::vector<double> path_of(const std::vector<Pose>& poses) {
  std::vector<double> path(poses.size(), 0.0);
  for (std::size_t k = 1; k < path.size(); ++k)
    path[k] = path[k - 1] + length(poses[k].translation - poses[k - 1].translation);
  return path;
}

}  // namespace plumb
