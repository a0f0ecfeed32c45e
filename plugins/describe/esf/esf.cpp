#include "esf.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "plumb/plugin/context.hpp"
#include "solid_grid.hpp"

namespace plumb::describe_esf {
namespace {

constexpr double least_area = 0.001;  // squared, in cells^4: below it a triple counts as a line
constexpr std::uint64_t tries_a_sample = 100;

/// The cloud about its centroid, in cells; empty if it has no extent.
std::vector<Eigen::Vector3f> scaled(const Cloud& cloud) {
  std::vector<Eigen::Vector3f> points;
  points.reserve(cloud.size());
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < cloud.size(); ++k) {
    if (!cloud.point(k).allFinite()) continue;
    points.push_back(cloud.point(k));
    sum += cloud.point(k).cast<double>();
  }
  if (points.size() < 3) return {};
  const Eigen::Vector3f centroid = (sum / static_cast<double>(points.size())).cast<float>();
  float farthest = 0;
  for (auto& point : points) {
    point -= centroid;
    farthest = std::max(farthest, point.norm());
  }
  if (!(farthest > 0)) return {};
  for (auto& point : points) point *= static_cast<float>(SolidGrid::side / 2) / farthest;
  return points;
}

/// How lines run: in solid cells, outside of them, or both.
enum Run { in, out, mixed };

Run run_of(const Line& line) {
  if (line.solid >= line.cells - 1) return in;
  return line.solid <= 7 ? out : mixed;
}

Run run_of_triangle(int cells, int solid) {
  if (solid <= 21) return out;
  return cells - solid < 4 ? in : mixed;
}

/// Values with their histogram's row, to be counted when the largest is known.
struct Collected {
  std::vector<std::pair<float, Run>> values;
  float largest = 0;
  void add(double value, Run run) {
    values.emplace_back(static_cast<float>(value), run);
    largest = std::max(largest, values.back().first);
  }
};

std::size_t bin(double from_0_to_1) {
  const long k = std::lround(from_0_to_1 * (esf_bins - 1));
  return static_cast<std::size_t>(std::clamp(k, 0l, static_cast<long>(esf_bins) - 1));
}

/// The ten histograms while they are filled.
class Histograms {
 public:
  /// Counts the triangle of three points; false if they lie on one line.
  bool add(const SolidGrid& grid, const Eigen::Vector3f& p1, const Eigen::Vector3f& p2,
           const Eigen::Vector3f& p3) {
    // Differences in double: those of floats would turn points of one line into triangles.
    const Eigen::Vector3d q1 = p1.cast<double>(), q2 = p2.cast<double>(), q3 = p3.cast<double>();
    const Eigen::Vector3d v21 = q2 - q1, v31 = q3 - q1, v23 = q2 - q3;
    const double a = v21.norm(), b = v31.norm(), c = v23.norm(), s = 0.5 * (a + b + c);
    const double squared_area = s * (s - a) * (s - b) * (s - c);
    if (!(squared_area > least_area)) return false;

    const Eigen::Vector3i cell1 = SolidGrid::cell_of(p1), cell2 = SolidGrid::cell_of(p2),
                          cell3 = SolidGrid::cell_of(p3);
    const Line lines[3] = {grid.trace(cell1, cell2), grid.trace(cell1, cell3),
                           grid.trace(cell2, cell3)};
    const double lengths[3] = {a, b, c};
    int cells = 0, solid = 0;
    for (int k = 0; k < 3; ++k) {
      const Run run = run_of(lines[k]);
      distances_.add(lengths[k], run);
      if (run == mixed) ++share_[bin(static_cast<double>(lines[k].solid) / lines[k].cells)];
      cells += lines[k].cells;
      solid += lines[k].solid;
    }
    const Run run = run_of_triangle(cells, solid);
    areas_.add(std::sqrt(std::sqrt(squared_area)), run);

    // Each angle counts with the length, in cells, of the line opposite to it.
    const auto angle = [](const Eigen::Vector3d& u, const Eigen::Vector3d& v,
                          double lengths_product) {
      return std::acos(std::min(std::abs(u.dot(v)) / lengths_product, 1.0)) /
             (std::numbers::pi / 2);
    };
    angles_[run][bin(angle(v21, v31, a * b))] += lines[2].cells / 32.0;
    angles_[run][bin(angle(v23, v31, c * b))] += lines[0].cells / 32.0;
    angles_[run][bin(angle(v23, v21, c * a))] += lines[1].cells / 32.0;
    return true;
  }

  /// All ten, weighted, with the sum 1.
  std::vector<float> normalised() const {
    double d3[3][esf_bins] = {}, d2[3][esf_bins] = {};
    for (const auto& [value, run] : areas_.values) ++d3[run][bin(value / areas_.largest)];
    for (const auto& [value, run] : distances_.values) ++d2[run][bin(value / distances_.largest)];
    const double* parts[10] = {angles_[in], angles_[out], angles_[mixed], d3[in],    d3[out],
                               d3[mixed],   d2[in],       d2[out],        d2[mixed], share_};
    static constexpr double weights[10] = {0.5, 0.5, 0.5, 0.5, 0.5, 1, 0.5, 2, 2, 1};
    double sum = 0;
    for (int part = 0; part < 10; ++part)
      for (std::size_t k = 0; k < esf_bins; ++k) sum += weights[part] * parts[part][k];
    std::vector<float> result;
    result.reserve(esf_size);
    for (int part = 0; part < 10; ++part)
      for (std::size_t k = 0; k < esf_bins; ++k)
        result.push_back(static_cast<float>(weights[part] * parts[part][k] / sum));
    return result;
  }

 private:
  double angles_[3][esf_bins] = {};
  double share_[esf_bins] = {};
  Collected areas_, distances_;
};

}  // namespace

std::optional<std::vector<float>> esf(const Cloud& cloud, std::uint32_t samples,
                                      std::uint64_t seed) {
  const std::vector<Eigen::Vector3f> points = scaled(cloud);
  if (points.empty()) return std::nullopt;
  const SolidGrid grid(points);
  Random random(seed);
  Histograms histograms;
  const auto any = [&] { return random.below(static_cast<std::uint32_t>(points.size())); };
  std::uint64_t tries = tries_a_sample * samples;
  for (std::uint32_t sample = 0; sample < samples;) {
    if (tries-- == 0) return std::nullopt;
    const auto k1 = any(), k2 = any(), k3 = any();
    if (k1 == k2 || k1 == k3 || k2 == k3) continue;
    sample += histograms.add(grid, points[k1], points[k2], points[k3]);
  }
  return histograms.normalised();
}

}  // namespace plumb::describe_esf
