#include "match_rmse.hpp"

#include <cmath>
#include <limits>

namespace plumb::measure_match_rmse {

IndexPairs nearest_pairs(const Segment& i, const Segment& j, const Pose& T_j_i,
                         double max_correspondence_distance,
                         std::optional<std::uint32_t> max_points) {
  IndexPairs pairs;
  if (i.cloud.empty() || j.cloud.empty() ||
      !moved(i.box, T_j_i).meets(j.box, static_cast<float>(max_correspondence_distance)))
    return pairs;
  const std::size_t n = i.cloud.size();
  const std::size_t stride =
      max_points && n > *max_points ? (n + *max_points - 1) / *max_points : 1;
  const Motion motion(T_j_i);
  const SearchTree& tree = j.tree();
  for (std::size_t k = 0; k < n; k += stride) {
    SearchTree::Neighbour nearest;
    if (tree.nearest_within(motion * i.cloud.point(k),
                            static_cast<float>(max_correspondence_distance), nearest))
      pairs.emplace_back(static_cast<std::uint32_t>(k), nearest.index);
  }
  return pairs;
}

double rmse_of(const IndexPairs& pairs, const Segment& i, const Segment& j, const Pose& T_j_i) {
  if (pairs.empty()) return std::numeric_limits<double>::quiet_NaN();
  const Eigen::Matrix3d r = T_j_i.matrix();
  double squares = 0;
  for (const auto& [p, q] : pairs)
    squares +=
        (r * i.cloud.point(p).cast<double>() + T_j_i.translation - j.cloud.point(q).cast<double>())
            .squaredNorm();
  return std::sqrt(squares / static_cast<double>(pairs.size()));
}

}  // namespace plumb::measure_match_rmse
