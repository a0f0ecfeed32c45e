#include "agreement.hpp"

#include <algorithm>
#include <cmath>

namespace plumb::accept_poses {

std::vector<std::uint32_t> common_points(const Segment& i, const Segment& j, const Pose& before,
                                         const Pose& after, const AgreementOptions& options) {
  const auto margin = static_cast<float>(options.max_distance);
  const Eigen::Vector3f low = j.box.low.array() - margin, high = j.box.high.array() + margin;
  const Motion motions[] = {Motion(before), Motion(after)};
  std::vector<std::uint32_t> inside;
  for (std::uint32_t k = 0; k < i.cloud.size(); ++k)
    for (const Motion& motion : motions) {
      const Eigen::Vector3f p = motion * i.cloud.point(k);
      if (!((p.array() >= low.array()).all() && (p.array() <= high.array()).all())) continue;
      inside.push_back(k);
      break;
    }
  std::vector<std::uint32_t> chosen;
  const std::size_t n = std::min<std::size_t>(inside.size(), options.max_points);
  for (std::size_t s = 0; s < n; ++s)
    chosen.push_back(inside[(2 * s + 1) * inside.size() / (2 * n)]);
  return chosen;
}

double disagreement(const Segment& i, const Segment& j, const std::vector<std::uint32_t>& points,
                    const Pose& T_j_i, const AgreementOptions& options) {
  if (points.empty()) return -1;
  const Motion motion(T_j_i);
  const auto most = static_cast<float>(options.max_distance);
  double sum = 0;
  for (const auto k : points) {
    const Eigen::Vector3f p = motion * i.cloud.point(k);
    SearchTree::Neighbour nearest;
    if (!j.tree().nearest_within(p, most, nearest)) {
      sum += options.max_distance;
      continue;
    }
    const bool plane = j.cloud.has_normals() && !j.cloud.normal(nearest.index).isZero();
    sum += plane ? std::abs(j.cloud.normal(nearest.index).dot(p - j.cloud.point(nearest.index)))
                 : std::sqrt(nearest.squared_distance);
  }
  return sum / static_cast<double>(points.size());
}

}  // namespace plumb::accept_poses
