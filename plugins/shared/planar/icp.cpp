#include "shared/planar/icp.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <vector>

namespace plumb::planar {
namespace {

/// A transformed source point, b, and its correspondence in the target, a, with the target's
/// normal there.
struct Pair {
  Eigen::Vector2d a, b, normal;
};

/// Neighbouring points share their errors (range bias, unevenness of walls): so many count as one.
constexpr double points_that_count_as_one = 10;

class Icp {
 public:
  Icp(const PlanarPoints& target, const SearchTree& tree, const PlanarPoints& source,
      const PlanarPose& start, const IcpOptions& options)
      : target_(target), tree_(tree), source_(source), start_(start), options_(options) {
    result_.T = start;
    pairs_.reserve(source.size());
  }

  IcpResult run() {
    if (options_.max_iterations == 0) pair_up();
    double mae_before = -1;
    while (result_.iterations < options_.max_iterations) {
      pair_up();
      ++result_.iterations;
      if (pairs_.size() < 3) break;
      // The paper's rule looks at the pairs that the last move brought about.
      if (options_.stop == Stop::ratio && mae_before >= 0 &&
          result_.mae >= options_.ratio * mae_before)
        break;
      mae_before = result_.mae;
      const double moved = options_.metric == Metric::point ? move_to_points() : move_to_lines();
      if (options_.stop == Stop::change && moved < options_.change) break;
    }
    result_.information = information();
    return result_;
  }

 private:
  void pair_up() {
    pairs_.clear();
    const double c = std::cos(result_.T.yaw), s = std::sin(result_.T.yaw);
    const auto reach = static_cast<float>(options_.max_correspondence_distance);
    const bool normals = target_.has_normals();
    double sum = 0;
    for (std::size_t k = 0; k < source_.size(); ++k) {
      const Eigen::Vector2d b(result_.T.x + c * source_.x[k] - s * source_.y[k],
                              result_.T.y + s * source_.x[k] + c * source_.y[k]);
      SearchTree::Neighbour found;
      if (!tree_.nearest_within({static_cast<float>(b.x()), static_cast<float>(b.y()), 0}, reach,
                                found))
        continue;
      const auto m = found.index;
      pairs_.push_back(
          {{target_.x[m], target_.y[m]},
           b,
           normals ? Eigen::Vector2d(target_.nx[m], target_.ny[m]) : Eigen::Vector2d::Zero()});
      sum += std::sqrt(found.squared_distance);
    }
    result_.pairs = static_cast<std::uint32_t>(pairs_.size());
    result_.overlap = source_.size() == 0 ? 0
                                          : static_cast<double>(pairs_.size()) /
                                                static_cast<double>(source_.size());
    result_.mae = pairs_.empty() ? 0 : sum / static_cast<double>(pairs_.size());
  }

  /// Eq. (4) to (11): both centred, the angle in closed form. Returns how far the pose moved.
  double move_to_points() {
    Eigen::Vector2d a = Eigen::Vector2d::Zero(), b = Eigen::Vector2d::Zero();
    for (const auto& pair : pairs_) a += pair.a, b += pair.b;
    a /= static_cast<double>(pairs_.size()), b /= static_cast<double>(pairs_.size());
    double sine = 0, cosine = 0;
    for (const auto& pair : pairs_) {
      const Eigen::Vector2d p = pair.a - a, q = pair.b - b;
      sine += q.x() * p.y() - q.y() * p.x();
      cosine += p.dot(q);
    }
    const double angle = std::atan2(sine, cosine);
    const double c = std::cos(angle), s = std::sin(angle);
    const PlanarPose move{a.x() - (c * b.x() - s * b.y()), a.y() - (s * b.x() + c * b.y()), angle};
    return set(move * result_.T);
  }

  /// One step of Gauss-Newton on the distances along the normals, weighted by Cauchy's loss.
  double move_to_lines() {
    Eigen::Matrix3d h = Eigen::Matrix3d::Zero();
    Eigen::Vector3d g = Eigen::Vector3d::Zero();
    const double per_variance = 1 / (options_.noise * options_.noise);
    for (const auto& pair : pairs_) {
      if (pair.normal.isZero()) continue;
      const double left = pair.normal.dot(pair.a - pair.b);
      const double weight =
          per_variance / points_that_count_as_one / (1 + 0.25 * left * left * per_variance);
      const Eigen::Vector3d row = derivative(pair);
      h += weight * row * row.transpose();
      g += weight * left * row;
    }
    if (options_.start_sigma) {
      const double place = std::pow(*options_.start_sigma, -2), heading = 9 * place;
      h.diagonal() += Eigen::Vector3d(place, place, heading);
      g += Eigen::Vector3d(place * (start_.x - result_.T.x), place * (start_.y - result_.T.y),
                           heading * wrapped(start_.yaw - result_.T.yaw));
    }
    h.diagonal().array() += 1e-3;  // what no pair sees stays
    const Eigen::Vector3d step = h.ldlt().solve(g);
    return set({result_.T.x + step.x(), result_.T.y + step.y(), result_.T.yaw + step.z()});
  }

  /// Of the distance along the normal by the pose's x, y, yaw.
  Eigen::Vector3d derivative(const Pair& pair) const {
    const Eigen::Vector2d arm = pair.b - Eigen::Vector2d(result_.T.x, result_.T.y);
    return {pair.normal.x(), pair.normal.y(),
            pair.normal.y() * arm.x() - pair.normal.x() * arm.y()};
  }

  double set(const PlanarPose& next) {
    const double moved = std::hypot(next.x - result_.T.x, next.y - result_.T.y) +
                         std::abs(wrapped(next.yaw - result_.T.yaw));
    result_.T = {next.x, next.y, wrapped(next.yaw)};
    return moved;
  }

  /// What the pairs' lines fix, whatever the metric: along a bare corridor that is nothing, however
  /// many points there are, and only the prior of the start is left. Without normals a pair fixes
  /// both directions. Brought to the source's coordinates, in which a constraint's error is taken.
  Eigen::Matrix3d information() const {
    Eigen::Matrix3d h = Eigen::Matrix3d::Zero();
    const bool normals = target_.has_normals();
    for (const auto& pair : pairs_) {
      if (normals) {
        const Eigen::Vector3d row = derivative(pair);
        h += row * row.transpose();
      } else {
        const Eigen::Vector2d arm = pair.b - Eigen::Vector2d(result_.T.x, result_.T.y);
        const Eigen::Vector3d x(1, 0, -arm.y()), y(0, 1, arm.x());
        h += x * x.transpose() + y * y.transpose();
      }
    }
    Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
    turn.topLeftCorner<2, 2>() = Eigen::Rotation2Dd(result_.T.yaw).toRotationMatrix();
    Eigen::Matrix3d all =
        turn.transpose() * h * turn / (options_.noise * options_.noise * points_that_count_as_one);
    if (options_.start_sigma)
      all.diagonal() += Eigen::Vector3d(1, 1, 9) * std::pow(*options_.start_sigma, -2);
    return all;
  }

  const PlanarPoints& target_;
  const SearchTree& tree_;
  const PlanarPoints& source_;
  PlanarPose start_;
  const IcpOptions& options_;
  std::vector<Pair> pairs_;
  IcpResult result_;
};

}  // namespace

IcpResult align(const PlanarPoints& target, const SearchTree& tree, const PlanarPoints& source,
                const PlanarPose& start, const IcpOptions& options) {
  return Icp(target, tree, source, start, options).run();
}

}  // namespace plumb::planar
