#include "occupancy.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "plumb/data/error.hpp"
#include "ray.hpp"

namespace plumb::map_occupancy_grid {
namespace {

/// A scan in units of cells.
struct ScanRays {
  float x, y;
  std::vector<float> hit_x, hit_y;    ///< ends of rays that hit something
  std::vector<float> open_x, open_y;  ///< ends of rays that were cut off
  std::int32_t first_row, last_row;   ///< rows touched by any ray
};

struct Bounds {
  Eigen::Array2d low = Eigen::Array2d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Array2d high = -low;
  void add(const Eigen::Vector2d& p) {
    low = low.min(p.array());
    high = high.max(p.array());
  }
};

/// Where a ray ends that is cut off at `most` [m].
Eigen::Vector2d cut_off(const Eigen::Vector2d& from, const Eigen::Vector2d& hit, double most) {
  return from + (hit - from) * (most / (hit - from).norm());
}

bool within(const Eigen::Vector2d& from, const Eigen::Vector2d& hit, double most) {
  return (hit - from).squaredNorm() <= most * most;
}

/// An empty map round all rays; its origin is a whole number of cells from the world's.
GridMap map_round(const std::vector<PlacedScan>& scans, const GridOptions& options) {
  Bounds bounds;
  for (const PlacedScan& scan : scans) {
    bounds.add(scan.from);
    for (const auto& hit : scan.hits)
      bounds.add(within(scan.from, hit, options.max_range)
                     ? hit
                     : cut_off(scan.from, hit, options.max_range));
    if (!scan.from.allFinite() || !bounds.low.allFinite() || !bounds.high.allFinite())
      throw Error(
          "a pose or a point is no number, so it has no place in the map; look at the trajectory");
  }
  GridMap map;
  map.resolution = options.resolution;
  if (scans.empty()) return map;
  const Eigen::Array2d first = (bounds.low / options.resolution).floor() - 1;
  const Eigen::Array2d cells = (bounds.high / options.resolution).floor() - first + 2;
  if (cells.prod() > static_cast<double>(options.max_cells) || cells.maxCoeff() > 4e6)
    throw Error("the map would have " + std::to_string(static_cast<long long>(cells.x())) + " x " +
                std::to_string(static_cast<long long>(cells.y())) + " cells, more than " +
                std::to_string(options.max_cells) +
                "; give a larger resolution, or look whether the trajectory runs away");
  map.origin = (first * options.resolution).matrix();
  map.columns = static_cast<std::uint32_t>(cells.x());
  map.rows = static_cast<std::uint32_t>(cells.y());
  return map;
}

ScanRays in_cells(const PlacedScan& scan, const GridMap& map, double max_range) {
  const auto cell = [&](const Eigen::Vector2d& p) -> Eigen::Vector2f {
    return ((p - map.origin) / map.resolution).cast<float>();
  };
  ScanRays rays;
  const Eigen::Vector2f from = cell(scan.from);
  rays.x = from.x();
  rays.y = from.y();
  rays.hit_x.reserve(scan.hits.size());
  rays.hit_y.reserve(scan.hits.size());
  float low = from.y(), high = from.y();
  for (const auto& hit : scan.hits) {
    const bool near = within(scan.from, hit, max_range);
    const Eigen::Vector2f end = cell(near ? hit : cut_off(scan.from, hit, max_range));
    (near ? rays.hit_x : rays.open_x).push_back(end.x());
    (near ? rays.hit_y : rays.open_y).push_back(end.y());
    low = std::min(low, end.y());
    high = std::max(high, end.y());
  }
  rays.first_row = static_cast<std::int32_t>(low);
  rays.last_row = static_cast<std::int32_t>(high);
  return rays;
}

/// Neighbouring rows, worked on by one thread.
class Band {
 public:
  Band(GridMap& map, const GridOptions& options, std::int32_t first, std::int32_t last)
      : map_(map),
        first_(first),
        last_(last),
        hit_(static_cast<float>(options.hit)),
        miss_(static_cast<float>(options.miss)),
        min_log_odds_(static_cast<float>(options.min_log_odds)),
        max_log_odds_(static_cast<float>(options.max_log_odds)),
        marks_(static_cast<std::size_t>(last - first + 1) * map.columns, 0) {}

  /// `mark` differs from scan to scan and is not 0.
  void add(const ScanRays& scan, std::uint32_t mark) {
    if (scan.last_row < first_ || scan.first_row > last_) return;
    for (std::size_t k = 0; k < scan.hit_x.size(); ++k) add_hit(scan.hit_x[k], scan.hit_y[k], mark);
    for (std::size_t k = 0; k < scan.hit_x.size(); ++k)
      clear({scan.x, scan.y, scan.hit_x[k], scan.hit_y[k]}, mark);
    for (std::size_t k = 0; k < scan.open_x.size(); ++k)
      clear({scan.x, scan.y, scan.open_x[k], scan.open_y[k]}, mark);
  }

  /// Seen cells in which hits and misses cancelled are told from those never seen.
  void finish() {
    float* cells = row(first_);
    for (std::size_t k = 0; k < marks_.size(); ++k)
      if (marks_[k] != 0 && cells[k] == 0) cells[k] = std::numeric_limits<float>::min();
  }

 private:
  float* row(std::int32_t r) {
    return map_.log_odds.data() + static_cast<std::size_t>(r) * map_.columns;
  }
  std::uint32_t* marks(std::int32_t r) {
    return marks_.data() + static_cast<std::size_t>(r - first_) * map_.columns;
  }

  void add_hit(float x, float y, std::uint32_t mark) {
    const auto r = static_cast<std::int32_t>(y), c = static_cast<std::int32_t>(x);
    if (r < first_ || r > last_ || marks(r)[c] == mark) return;
    marks(r)[c] = mark;
    float& cell = row(r)[c];
    cell = std::min(cell + hit_, max_log_odds_);
  }
  void clear(const Ray& ray, std::uint32_t mark) {
    traverse(ray, first_, last_, [&](std::int32_t r, std::int32_t from, std::int32_t to) {
      float* cells = row(r);
      std::uint32_t* marked = marks(r);
      for (std::int32_t c = from; c <= to; ++c) {
        const float less = std::max(cells[c] - miss_, min_log_odds_);
        cells[c] = marked[c] == mark ? cells[c] : less;
        marked[c] = mark;
      }
    });
  }

  GridMap& map_;
  std::int32_t first_, last_;
  float hit_, miss_, min_log_odds_, max_log_odds_;
  std::vector<std::uint32_t> marks_;
};

}  // namespace

PlacedScan placed(const Cloud& cloud, const Pose& T_world_sensor) {
  PlacedScan scan{T_world_sensor.translation.head<2>(), {}};
  const Eigen::Matrix<double, 2, 3> r = T_world_sensor.matrix().topRows<2>();
  scan.hits.reserve(cloud.size());
  for (std::size_t k = 0; k < cloud.size(); ++k)
    scan.hits.push_back(r * cloud.point(k).cast<double>() + scan.from);
  return scan;
}

GridMap occupancy(const std::vector<PlacedScan>& scans, const GridOptions& options,
                  const parallel::Loop& parallel) {
  GridMap map = map_round(scans, options);
  map.log_odds.assign(std::size_t{map.columns} * map.rows, 0.0f);
  std::vector<ScanRays> rays(scans.size());
  constexpr std::size_t block = 64;
  parallel((scans.size() + block - 1) / block, [&](std::size_t b) {
    for (std::size_t k = b * block; k < std::min(scans.size(), (b + 1) * block); ++k)
      rays[k] = in_cells(scans[k], map, options.max_range);
  });

  // A cell sees the scans in their order whatever the bands are, so these change nothing but the
  // speed.
  const std::size_t height = std::max<std::size_t>(16, (map.rows + 47) / 48);
  parallel((map.rows + height - 1) / height, [&](std::size_t b) {
    const std::size_t last = std::min<std::size_t>(map.rows, (b + 1) * height) - 1;
    Band band(map, options, static_cast<std::int32_t>(b * height), static_cast<std::int32_t>(last));
    for (std::size_t k = 0; k < rays.size(); ++k)
      band.add(rays[k], static_cast<std::uint32_t>(k + 1));
    band.finish();
  });
  return map;
}

}  // namespace plumb::map_occupancy_grid
