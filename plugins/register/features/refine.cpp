#include "refine.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "plumb/slam/geometry/pair_moments.hpp"
#include "shared/selection/evenly.hpp"

namespace plumb::register_features {
namespace {

struct PlanePair {
  Eigen::Vector3d p, q, normal;  ///< p in i's coordinates; q and its normal in j's
};

struct Asked {
  std::vector<PlanePair> pairs;
  std::size_t asked = 0;
  std::vector<Eigen::Vector3f> normals;  ///< of all points asked, in their own cloud
  std::vector<bool> paired;              ///< of each of these
};

/// Points of `a` in the box of `b`, at most `most`, with the nearest of b within `max` and a normal
/// that agrees.
Asked pairs_of(const Segment& a, const Segment& b, const Pose& T_b_a, double max, double max_angle,
               std::uint32_t most) {
  const Motion motion(T_b_a);
  const auto margin = static_cast<float>(max);
  const Eigen::Vector3f low = b.box.low.array() - margin, high = b.box.high.array() + margin;
  std::vector<std::uint32_t> inside;
  for (std::uint32_t k = 0; k < a.cloud.size(); ++k) {
    const Eigen::Vector3f p = motion * a.cloud.point(k);
    if ((p.array() >= low.array()).all() && (p.array() <= high.array()).all()) inside.push_back(k);
  }
  Asked result;
  const std::vector<std::uint32_t> chosen = selection::evenly(inside.size(), most);
  result.asked = chosen.size();
  const auto cosine = static_cast<float>(std::cos(max_angle));
  for (const auto c : chosen) {
    const std::uint32_t k = inside[c];
    result.normals.push_back(a.cloud.normal(k));
    result.paired.push_back(false);
    SearchTree::Neighbour nearest;
    if (!b.tree().nearest_within(motion * a.cloud.point(k), margin, nearest)) continue;
    const Eigen::Vector3f normal = b.cloud.normal(nearest.index);
    if ((motion.r * a.cloud.normal(k)).dot(normal) < cosine)
      continue;  // also where either is unknown
    result.paired.back() = true;
    result.pairs.push_back({a.cloud.point(k).cast<double>(),
                            b.cloud.point(nearest.index).cast<double>(), normal.cast<double>()});
  }
  return result;
}

double residual(const PlanePair& pair, const Pose& T_j_i) {
  return pair.normal.dot(T_j_i * pair.p - pair.q);
}

Pose step(const std::vector<PlanePair>& pairs, const Pose& T_j_i, double scale) {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  for (const auto& pair : pairs) centre += pair.p;
  centre /= static_cast<double>(pairs.size());
  PlanePairSums sums;
  for (const auto& pair : pairs) {
    const double r = residual(pair, T_j_i);
    sums.add(pair.p - centre, pair.normal, r, 1 / (1 + r * r / (scale * scale)));
  }
  return fitted({{T_j_i, centre}, factor_of(sums.moments())}, 5);
}

/// Share of the points asked that have a pair; also that of the points alone whose normals are not
/// along the commonest direction (the ground lies on itself wherever a cloud is put), whichever is
/// less.
double share(const Asked& asked) {
  if (asked.asked == 0) return 0;
  const double all = static_cast<double>(asked.pairs.size()) / static_cast<double>(asked.asked);
  Eigen::Matrix3f scatter = Eigen::Matrix3f::Zero();
  for (const auto& normal : asked.normals) scatter += normal * normal.transpose();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> eigen;
  eigen.computeDirect(scatter);
  const Eigen::Vector3f commonest = eigen.eigenvectors().col(2);
  double others = 0, paired = 0;
  for (std::size_t k = 0; k < asked.normals.size(); ++k)
    if (!asked.normals[k].isZero() && std::abs(asked.normals[k].dot(commonest)) < 0.7f)
      ++others, paired += asked.paired[k];
  return others < 30 ? all : std::min(all, paired / others);
}

}  // namespace

Registration refined(const Segment& i, const Segment& j, const Pose& start,
                     const RefineOptions& options, double independent) {
  Registration result;
  Pose T_j_i = start;
  std::vector<PlanePair> pairs;
  for (std::uint32_t n = 0; n < options.max_iterations; ++n) {
    const double along =
        std::min(1.0, 2.0 * n / options.max_iterations);  // the second half has the last distance
    const double max =
        options.initial_max_correspondence_distance *
        std::pow(options.max_correspondence_distance / options.initial_max_correspondence_distance,
                 along);
    pairs = pairs_of(i, j, T_j_i, max, options.max_normal_angle, options.max_points).pairs;
    ++result.iterations;
    if (pairs.size() < 30) break;
    const Pose before = T_j_i;
    T_j_i = step(pairs, T_j_i, 0.5 * max);
    const Pose moved = before.inverse() * T_j_i;
    if (along >= 1 && moved.translation.norm() < 1e-3 && angle(moved) < 1e-4) break;
  }
  const Asked forth = pairs_of(i, j, T_j_i, options.max_correspondence_distance,
                               options.max_normal_angle, options.max_points);
  const Asked back = pairs_of(j, i, T_j_i.inverse(), options.max_correspondence_distance,
                              options.max_normal_angle, options.max_points);
  result.T_i_j = T_j_i.inverse();
  result.pairs = static_cast<std::uint32_t>(forth.pairs.size());
  result.overlap = static_cast<float>(std::min(share(forth), share(back)));
  if (forth.pairs.size() < 30) return result;
  double sum = 0, squares = 0;
  Matrix6d information = Matrix6d::Zero();
  for (const auto& pair : forth.pairs) {
    const double r = residual(pair, T_j_i);
    sum += std::abs(r);
    squares += r * r;
    const Eigen::Vector3d at = T_j_i * pair.p;
    Vector6d row;
    row << pair.normal, at.cross(pair.normal);
    information += row * row.transpose();
  }
  const auto count = static_cast<double>(forth.pairs.size());
  result.mae = static_cast<float>(sum / count);
  const double noise = std::max(squares / count, 1e-4);
  result.information = information * (std::min(independent, count) / count / noise);
  return result;
}

}  // namespace plumb::register_features
