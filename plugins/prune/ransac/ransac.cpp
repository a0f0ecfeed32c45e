#include "ransac.hpp"

#include <Eigen/SVD>
#include <algorithm>
#include <array>
#include <cmath>

namespace plumb {
namespace {

using Triple = std::array<std::uint32_t, 3>;

template <class Indices>
Pose fit(const Matches& matches, const Indices& indices) {
  Eigen::Vector3d mean_p = Eigen::Vector3d::Zero(), mean_q = Eigen::Vector3d::Zero();
  for (const auto k : indices) {
    mean_p += matches.p[k].template cast<double>();
    mean_q += matches.q[k].template cast<double>();
  }
  mean_p /= static_cast<double>(indices.size());
  mean_q /= static_cast<double>(indices.size());
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const auto k : indices)
    spread += (matches.p[k].template cast<double>() - mean_p) *
              (matches.q[k].template cast<double>() - mean_q).transpose();
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(spread, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d proper = Eigen::Matrix3d::Identity();
  proper(2, 2) = svd.matrixU().determinant() * svd.matrixV().determinant() < 0 ? -1 : 1;
  const Eigen::Matrix3d r = svd.matrixU() * proper * svd.matrixV().transpose();
  return {r, mean_p - r * mean_q};
}

Triple three_of(std::uint32_t n, Random& random) {
  Triple t{random.below(n), random.below(n - 1), random.below(n - 2)};
  t[1] += t[1] >= t[0];
  const auto low = std::min(t[0], t[1]), high = std::max(t[0], t[1]);
  t[2] += t[2] >= low;
  t[2] += t[2] >= high;
  return t;
}

/// Whether the two triangles can be one moved by up to `max_correspondence_distance` at each
/// corner, and can tell a rotation.
bool alike(const Matches& m, const Triple& t, float max_correspondence_distance) {
  for (int k = 0; k < 3; ++k) {
    const auto a = t[k], b = t[(k + 1) % 3];
    const float side_p = (m.p[a] - m.p[b]).norm(), side_q = (m.q[a] - m.q[b]).norm();
    if (std::abs(side_p - side_q) > 2 * max_correspondence_distance) return false;
    if (std::min(side_p, side_q) < 4 * max_correspondence_distance) return false;
  }
  const Eigen::Vector3f u = m.q[t[1]] - m.q[t[0]], v = m.q[t[2]] - m.q[t[0]];
  return u.cross(v).norm() > 0.1f * u.norm() * v.norm();
}

std::vector<std::uint32_t> agreeing(const Matches& m, const Pose& T_i_j,
                                    double max_correspondence_distance) {
  const Motion i_from_j(T_i_j);
  const auto squared_max =
      static_cast<float>(max_correspondence_distance * max_correspondence_distance);
  std::vector<std::uint32_t> inliers;
  for (std::uint32_t k = 0; k < m.size(); ++k)
    if ((m.p[k] - i_from_j * m.q[k]).squaredNorm() <= squared_max) inliers.push_back(k);
  return inliers;
}

double samples_wanted(std::size_t inliers, std::size_t pairs, double confidence) {
  const double good = std::pow(static_cast<double>(inliers) / static_cast<double>(pairs), 3);
  return good >= 1 ? 0 : std::log(1 - confidence) / std::log1p(-good);
}

}  // namespace

Pose rigid_fit(const Matches& matches, const std::vector<std::uint32_t>& indices) {
  return fit(matches, indices);
}

Consensus ransac(const Matches& matches, const RansacOptions& options, Random random) {
  Consensus best;
  if (matches.size() < 3) return best;
  const auto pairs = static_cast<std::uint32_t>(matches.size());
  double wanted = options.max_iterations;
  for (; best.samples < wanted && best.samples < options.max_iterations; ++best.samples) {
    const Triple triple = three_of(pairs, random);
    if (!alike(matches, triple, static_cast<float>(options.max_correspondence_distance))) continue;
    const Pose T_i_j = fit(matches, triple);
    auto inliers = agreeing(matches, T_i_j, options.max_correspondence_distance);
    if (inliers.size() < 3 || inliers.size() <= best.inliers.size()) continue;
    best.T_i_j = T_i_j;
    best.inliers = std::move(inliers);
    wanted = samples_wanted(best.inliers.size(), pairs, options.confidence);
  }
  while (!best.inliers.empty()) {
    const Pose finer = rigid_fit(matches, best.inliers);
    auto inliers = agreeing(matches, finer, options.max_correspondence_distance);
    if (inliers.size() < best.inliers.size()) break;
    const bool grew = inliers.size() > best.inliers.size();
    best.T_i_j = finer;
    best.inliers = std::move(inliers);
    if (!grew) break;
  }
  return best;
}

}  // namespace plumb
