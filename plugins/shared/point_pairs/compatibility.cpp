#include "shared/point_pairs/compatibility.hpp"

#include <algorithm>
#include <cmath>

namespace plumb::point_pairs {

BitGraph compatibility_of(std::span<const Eigen::Vector3f> p, std::span<const Eigen::Vector3f> q,
                          std::span<const std::uint32_t> chosen, double tolerance,
                          double min_length) {
  BitGraph graph(chosen.size());
  const auto widest = static_cast<float>(tolerance), shortest = static_cast<float>(min_length);
  for (std::size_t a = 0; a < chosen.size(); ++a)
    for (std::size_t b = a + 1; b < chosen.size(); ++b) {
      const float of_p = (p[chosen[a]] - p[chosen[b]]).norm(),
                  of_q = (q[chosen[a]] - q[chosen[b]]).norm();
      if (std::abs(of_p - of_q) <= widest && std::min(of_p, of_q) >= shortest) graph.join(a, b);
    }
  return graph;
}

}  // namespace plumb::point_pairs
