#include "map_error.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

namespace plumb::measure_map_error {
namespace {

/// Points in square buckets of edge `size`: is one of them nearer than `size` to a place?
class Buckets {
 public:
  Buckets(const std::vector<Eigen::Vector2d>& points, double size) : size_(size) {
    for (const auto& p : points) buckets_[key(cell(p.x()), cell(p.y()))].push_back(p);
  }
  bool any_near(const Eigen::Vector2d& p) const {
    for (std::int32_t y = cell(p.y()) - 1; y <= cell(p.y()) + 1; ++y)
      for (std::int32_t x = cell(p.x()) - 1; x <= cell(p.x()) + 1; ++x)
        if (const auto at = buckets_.find(key(x, y)); at != buckets_.end())
          for (const auto& q : at->second)
            if ((p - q).norm() <= size_) return true;
    return false;
  }

 private:
  std::int32_t cell(double v) const { return static_cast<std::int32_t>(std::floor(v / size_)); }
  static std::uint64_t key(std::int32_t x, std::int32_t y) {
    return std::uint64_t{static_cast<std::uint32_t>(x)} << 32 | static_cast<std::uint32_t>(y);
  }
  double size_;
  std::unordered_map<std::uint64_t, std::vector<Eigen::Vector2d>> buckets_;
};

/// Share of places along the walls, `step` apart, that have a cell near them.
double covered(const std::vector<Wall>& walls, const Buckets& cells, double step) {
  double seen = 0, all = 0;
  for (const Wall& wall : walls) {
    const double length = (wall.b - wall.a).norm();
    const auto pieces = std::max(1.0, std::ceil(length / step));
    for (double k = 0; k < pieces; ++k) {
      all += length / pieces;
      if (cells.any_near(wall.a + (k + 0.5) / pieces * (wall.b - wall.a))) seen += length / pieces;
    }
  }
  return all > 0 ? seen / all : 0;
}

}  // namespace

PlanarPose planar_alignment(const PosePairs& pairs) {
  if (pairs.size() == 0) return {};
  const auto n = static_cast<double>(pairs.size());
  Eigen::Vector2d mean_a = Eigen::Vector2d::Zero(), mean_b = mean_a;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    mean_a += pairs.estimate[k].translation.head<2>() / n;
    mean_b += pairs.truth[k].translation.head<2>() / n;
  }
  double sine = 0, cosine = 0, spread = 0, heading_sine = 0, heading_cosine = 0;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const Eigen::Vector2d a = pairs.estimate[k].translation.head<2>() - mean_a;
    const Eigen::Vector2d b = pairs.truth[k].translation.head<2>() - mean_b;
    sine += a.x() * b.y() - a.y() * b.x();
    cosine += a.dot(b);
    spread = std::max(spread, a.norm());
    const double turn =
        log_rotation(pairs.truth[k].rotation * pairs.estimate[k].rotation.conjugate()).z();
    heading_sine += std::sin(turn);
    heading_cosine += std::cos(turn);
  }
  PlanarPose motion;
  motion.yaw = spread > 1e-3 ? std::atan2(sine, cosine) : std::atan2(heading_sine, heading_cosine);
  const Eigen::Vector2d shift = mean_b - motion * mean_a;
  motion.x = shift.x(), motion.y = shift.y();
  return motion;
}

MapError map_error(const GridMap& map, const std::vector<Wall>& walls, const PlanarPose& T_plan_map,
                   float threshold, double max_wall_distance, const parallel::Loop& parallel) {
  std::vector<Eigen::Vector2d> cells;
  for (std::size_t r = 0; r < map.rows; ++r)
    for (std::size_t c = 0; c < map.columns; ++c)
      if (map.log_odds[r * map.columns + c] > threshold)
        cells.push_back(
            T_plan_map *
            (map.origin + map.resolution * Eigen::Vector2d(static_cast<double>(c) + 0.5,
                                                           static_cast<double>(r) + 0.5)));
  MapError error;
  error.occupied = cells.size();
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  if (cells.empty()) return {0, nan, nan, nan, nan, nan, nan};

  const WallTree tree(walls);
  std::vector<double> distances(cells.size());
  constexpr std::size_t block = 1024;
  parallel((cells.size() + block - 1) / block, [&](std::size_t b) {
    for (std::size_t k = b * block; k < std::min(cells.size(), (b + 1) * block); ++k)
      distances[k] = tree.distance_to(cells[k]);
  });
  const auto n = static_cast<double>(cells.size());
  std::ranges::sort(distances);
  for (const double d : distances)
    error.mean += d / n, error.rms += d * d / n,
        error.accuracy += d <= max_wall_distance ? 1 / n : 0;
  error.rms = std::sqrt(error.rms);
  error.largest = distances.back();
  error.percentile_99 = distances[static_cast<std::size_t>(std::ceil(0.99 * n)) - 1];
  error.coverage = covered(walls, Buckets(cells, max_wall_distance), map.resolution);
  return error;
}

}  // namespace plumb::measure_map_error
