#include "proximity.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

namespace plumb::loops_proximity {
namespace {

using Cell = std::tuple<long, long, long>;

Cell cell_of(const Eigen::Vector3d& place, double size) {
  return {std::lround(std::floor(place.x() / size)), std::lround(std::floor(place.y() / size)),
          std::lround(std::floor(place.z() / size))};
}

}  // namespace

Edges revisits(const Poses& poses, const ProximityOptions& options) {
  Edges edges;
  edges.segments = static_cast<std::uint32_t>(poses.size());
  std::vector<double> path(poses.size(), 0);
  std::map<Cell, std::vector<std::uint32_t>> cells;
  const auto place = [&](std::uint32_t k) { return poses.T_world_segment[k].translation; };
  std::vector<std::uint32_t> near;
  for (std::uint32_t j = 0; j < poses.size(); ++j) {
    if (j > 0) {
      const Pose step = poses.relative(j - 1, j);
      path[j] = path[j - 1] + step.translation.norm() + options.turn_length * angle(step);
    }
    const auto [cx, cy, cz] = cell_of(place(j), options.max_distance);
    near.clear();
    for (long x = cx - 1; x <= cx + 1; ++x)
      for (long y = cy - 1; y <= cy + 1; ++y)
        for (long z = cz - 1; z <= cz + 1; ++z)
          if (const auto at = cells.find({x, y, z}); at != cells.end())
            for (const auto i : at->second)
              if (path[j] - path[i] >= options.min_path_separation &&
                  (place(i) - place(j)).norm() <= options.max_distance)
                near.push_back(i);
    std::sort(near.begin(), near.end());
    for (std::size_t first = 0; first < near.size();) {
      std::size_t end = first + 1;
      while (end < near.size() && near[end] == near[end - 1] + 1) ++end;
      const auto nearest =
          *std::min_element(near.begin() + static_cast<std::ptrdiff_t>(first),
                            near.begin() + static_cast<std::ptrdiff_t>(end), [&](auto a, auto b) {
                              return (place(a) - place(j)).norm() < (place(b) - place(j)).norm();
                            });
      const double distance = (place(nearest) - place(j)).norm();
      edges.list.push_back({nearest, j, EdgeKind::neighbour,
                            static_cast<float>(1 - distance / options.max_distance),
                            static_cast<float>(distance)});
      first = end;
    }
    cells[{cx, cy, cz}].push_back(j);
  }
  std::sort(edges.list.begin(), edges.list.end(),
            [](const Edge& a, const Edge& b) { return std::pair(a.i, a.j) < std::pair(b.i, b.j); });
  return edges;
}

}  // namespace plumb::loops_proximity
