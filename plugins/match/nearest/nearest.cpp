#include "nearest.hpp"

#include <cmath>

#include "shared/selection/evenly.hpp"

namespace plumb::match_nearest {
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
    const auto chosen = selection::evenly(count, *most);
    for (std::size_t n = 0; n < chosen.size(); ++n) inside[n] = inside[chosen[n]];
    count = chosen.size();
  }
  inside.resize(count);
  return inside;
}

/// Asks `of`'s points for the nearest of `near`, `reach` [m]; adds the pairs to matches with p in i
/// and q in j, whichever of the two asks.
void ask(const Segment& of, const Segment& near, const Motion& near_from_of,
         const std::optional<std::uint32_t>& most, bool of_is_i, const NearestOptions& options,
         Matches& matches) {
  const auto max = static_cast<float>(options.max_correspondence_distance);
  const float least_cosine =
      options.max_normal_angle ? static_cast<float>(std::cos(*options.max_normal_angle)) : -2;
  for (const auto k : near_box(of.cloud, near_from_of, near.box, max, most)) {
    const Eigen::Vector3f p = of.cloud.point(k);
    SearchTree::Neighbour nearest;
    if (!near.tree().nearest_within(near_from_of * p, max, nearest)) continue;
    ++matches.found;
    const Eigen::Vector3f q = near.cloud.point(nearest.index);
    const Eigen::Vector3f normal = options.to_plane || options.max_normal_angle
                                       ? near.cloud.normal(nearest.index)
                                       : Eigen::Vector3f::Zero();
    if (options.to_plane && normal.isZero()) continue;
    if (options.max_normal_angle &&
        (near_from_of.r * of.cloud.normal(k)).dot(normal) < least_cosine)
      continue;
    matches.p.push_back(of_is_i ? p : q);
    matches.q.push_back(of_is_i ? q : p);
    matches.index_p.push_back(of_is_i ? k : nearest.index);
    matches.index_q.push_back(of_is_i ? nearest.index : k);
    if (options.to_plane)
      matches.normal_q.push_back(of_is_i ? normal
                                         : Eigen::Vector3f(near_from_of.r.transpose() * normal));
  }
}

}  // namespace

Matches nearest_pairs(const Segment& i, const Segment& j, const Pose& T_i_j,
                      const NearestOptions& options) {
  Matches matches;
  matches.to_plane = options.to_plane;
  if (!j.box.meets(moved(i.box, T_i_j.inverse()),
                   static_cast<float>(options.max_correspondence_distance)))
    return matches;
  auto each_way = options.max_points;
  if (each_way && options.both_ways) each_way = (*each_way + 1) / 2;
  ask(i, j, Motion(T_i_j.inverse()), each_way, true, options, matches);
  if (options.both_ways) ask(j, i, Motion(T_i_j), each_way, false, options, matches);
  matches.weight.assign(matches.size(), 1.0f);
  return matches;
}

}  // namespace plumb::match_nearest
