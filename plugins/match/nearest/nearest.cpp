#include "nearest.hpp"

#include <cmath>

namespace plumb {
namespace {

/// Indices of i's points that lie in j's box, made wider by `margin`; evenly thinned to `most`.
std::vector<std::uint32_t> near_box(const Cloud& cloud, const Motion& j_from_i, const Box& box,
                                    float margin, const std::optional<std::uint32_t>& most) {
  const Eigen::Vector3f low = box.low.array() - margin, high = box.high.array() + margin;
  std::vector<std::uint32_t> inside(cloud.size());
  std::size_t count = 0;
  const Eigen::Matrix3f& r = j_from_i.r;
  const Eigen::Vector3f& t = j_from_i.t;
  for (std::uint32_t k = 0; k < cloud.size(); ++k) {
    const float x = cloud.x[k], y = cloud.y[k], z = cloud.z[k];
    const float a = r(0, 0) * x + r(0, 1) * y + r(0, 2) * z + t.x();
    const float b = r(1, 0) * x + r(1, 1) * y + r(1, 2) * z + t.y();
    const float c = r(2, 0) * x + r(2, 1) * y + r(2, 2) * z + t.z();
    inside[count] = k;
    count += (a >= low.x()) & (a <= high.x()) & (b >= low.y()) & (b <= high.y()) & (c >= low.z()) &
             (c <= high.z());
  }
  if (most && count > *most) {
    for (std::uint64_t n = 0; n < *most; ++n) inside[n] = inside[n * count / *most];
    count = *most;
  }
  inside.resize(count);
  return inside;
}

}  // namespace

Matches nearest_pairs(const Segment& i, const Segment& j, const Pose& T_i_j,
                      const NearestOptions& options) {
  Matches matches;
  matches.to_plane = options.to_plane;
  const auto max = static_cast<float>(options.max);
  if (!j.box.meets(moved(i.box, T_i_j.inverse()), max)) return matches;
  const Motion j_from_i(T_i_j.inverse());
  const auto asked = near_box(i.cloud, j_from_i, j.box, max, options.most_points);
  const float least_cosine =
      options.reject_normals ? static_cast<float>(std::cos(*options.reject_normals)) : -2;
  for (const auto k : asked) {
    const Eigen::Vector3f p = i.cloud.point(k);
    SearchTree::Neighbour nearest;
    if (!j.tree().nearest_within(j_from_i * p, max, nearest)) continue;
    ++matches.found;
    if (options.to_plane && j.cloud.normal(nearest.index).isZero()) continue;
    if (options.reject_normals &&
        (j_from_i.r * i.cloud.normal(k)).dot(j.cloud.normal(nearest.index)) < least_cosine)
      continue;
    matches.p.push_back(p);
    matches.q.push_back(j.cloud.point(nearest.index));
    matches.index_p.push_back(k);
    matches.index_q.push_back(nearest.index);
    if (options.to_plane) matches.normal_q.push_back(j.cloud.normal(nearest.index));
  }
  matches.weight.assign(matches.size(), 1.0f);
  return matches;
}

}  // namespace plumb
