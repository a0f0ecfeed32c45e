#include "ransac.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "shared/point_pairs/rigid_fit.hpp"

namespace plumb::prune_ransac {
namespace {

using Triple = std::array<std::uint32_t, 3>;

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

/// The pairs that agree with a motion, in order.
std::vector<std::uint32_t> agreeing(const Matches& m, const Pose& T_i_j,
                                    double max_correspondence_distance) {
  return point_pairs::agreeing(m.q, m.p, T_i_j, max_correspondence_distance);
}

double samples_wanted(std::size_t inliers, std::size_t pairs, double confidence) {
  const double good = std::pow(static_cast<double>(inliers) / static_cast<double>(pairs), 3);
  return good >= 1 ? 0 : std::log(1 - confidence) / std::log1p(-good);
}

}  // namespace

Consensus ransac(const Matches& matches, const RansacOptions& options, Random random) {
  Consensus best;
  if (matches.size() < 3) return best;
  const auto pairs = static_cast<std::uint32_t>(matches.size());
  double wanted = options.max_iterations;
  for (; best.samples < wanted && best.samples < options.max_iterations; ++best.samples) {
    const Triple triple = three_of(pairs, random);
    if (!alike(matches, triple, static_cast<float>(options.max_correspondence_distance))) continue;
    const Pose T_i_j = point_pairs::rigid_fit(matches.q, matches.p, triple);
    auto inliers = agreeing(matches, T_i_j, options.max_correspondence_distance);
    if (inliers.size() < 3 || inliers.size() <= best.inliers.size()) continue;
    best.T_i_j = T_i_j;
    best.inliers = std::move(inliers);
    wanted = samples_wanted(best.inliers.size(), pairs, options.confidence);
  }
  while (!best.inliers.empty()) {
    const Pose finer = point_pairs::rigid_fit(matches.q, matches.p, best.inliers);
    auto inliers = agreeing(matches, finer, options.max_correspondence_distance);
    if (inliers.size() < best.inliers.size()) break;
    const bool grew = inliers.size() > best.inliers.size();
    best.T_i_j = finer;
    best.inliers = std::move(inliers);
    if (!grew) break;
  }
  return best;
}

}  // namespace plumb::prune_ransac
