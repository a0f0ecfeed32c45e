#include "refine.hpp"

#include <algorithm>
#include <cmath>

#include "plumb/slam/geometry/symmetric.hpp"
#include "shared/selection/evenly.hpp"

namespace plumb::refine_frames {
namespace {

/// Normal equations of a move (v, w) that takes a pose (R, t) to (R exp(w), t + v).
struct Normal {
  Matrix6d h = Matrix6d::Zero();
  Vector6d g = Vector6d::Zero();
  double weight = 0;
  std::uint32_t pairs = 0;

  void add(const Vector6d& row, double residual, double w) {
    h.noalias() += w * row * row.transpose();
    g.noalias() += w * residual * row;
    weight += w;
    ++pairs;
  }
};

void add_pairs(const std::vector<Eigen::Vector3f>& points, const Pose& T_world_frame,
               const Target& target, double max, double noise, Normal& sums) {
  const Pose T_segment_frame = target.T_world_segment.inverse() * T_world_frame;
  const Motion motion(T_segment_frame);
  const Eigen::Matrix3d R_world_segment = target.T_world_segment.matrix(),
                        R_frame = T_world_frame.matrix();
  const Cloud& cloud = target.segment->cloud;
  const SearchTree& tree = target.segment->tree();
  for (const auto& point : points) {
    const Eigen::Vector3f at = motion * point;
    SearchTree::Neighbour nearest;
    if (!tree.nearest_within(at, static_cast<float>(max), nearest)) continue;
    const Eigen::Vector3f normal = cloud.normal(nearest.index);
    if (normal.isZero()) continue;
    const double r = static_cast<double>(normal.dot(at - cloud.point(nearest.index)));
    const Eigen::Vector3d n = R_world_segment * normal.cast<double>();
    const Eigen::Vector3d lever = point.cast<double>().cross(R_frame.transpose() * n);
    Vector6d row;
    for (int axis = 0; axis < 3; ++axis) row[axis] = n[axis], row[3 + axis] = lever[axis];
    sums.add(row, r, 1 / (1 + r * r / (noise * noise)));
  }
}

}  // namespace

FramePose registered(const Cloud& cloud, const Pose& start, const std::vector<Target>& targets,
                     const FrameOptions& options) {
  std::vector<Eigen::Vector3f> points;
  for (const auto k : selection::evenly(cloud.size(), options.max_points))
    points.push_back(cloud.point(k));
  Vector6d prior;
  for (int axis = 0; axis < 6; ++axis)
    prior[axis] = std::pow(axis < 3 ? options.translation_sigma : options.rotation_sigma, -2);

  FramePose result{start, 0};
  for (std::uint32_t k = 0; k < options.max_iterations; ++k) {
    const double along =
        options.max_iterations > 1 ? std::min(1.0, 2.0 * k / (options.max_iterations - 1)) : 1.0;
    const double max =
        options.max_correspondence_distance *
        std::pow(options.final_max_correspondence_distance / options.max_correspondence_distance,
                 along);
    Normal sums;
    for (const auto& target : targets)
      if (!target.segment->cloud.empty())
        add_pairs(points, result.T_world_frame, target, max, options.noise, sums);
    result.pairs = sums.pairs;
    if (sums.pairs < 30) return {start, sums.pairs};
    const double unit =
        std::min(1.0, options.max_weight / sums.weight) / (options.noise * options.noise);
    const Eigen::Vector3d turned =
        log_rotation(start.rotation.conjugate() * result.T_world_frame.rotation);
    Vector6d moved;
    for (int axis = 0; axis < 3; ++axis) {
      moved[axis] = result.T_world_frame.translation[axis] - start.translation[axis];
      moved[3 + axis] = turned[axis];
    }
    Matrix6d h = unit * sums.h;
    h.diagonal() += prior;
    const Vector6d g = unit * sums.g + prior.cwiseProduct(moved);
    const Vector6d step = -solve_symmetric(h, g);
    result.T_world_frame = {
        (result.T_world_frame.rotation * exp_rotation(Eigen::Vector3d(step[3], step[4], step[5])))
            .normalized(),
        result.T_world_frame.translation + Eigen::Vector3d(step[0], step[1], step[2])};
    if (along >= 1 && step.head<3>().norm() < 1e-3 && step.tail<3>().norm() < 1e-4) break;
  }
  return result;
}

}  // namespace plumb::refine_frames
