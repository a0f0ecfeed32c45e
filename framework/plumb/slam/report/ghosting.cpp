#include "plumb/slam/report/ghosting.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "plumb/data/error.hpp"
#include "plumb/engine/run/parallel.hpp"
#include "plumb/slam/geometry/search_tree.hpp"
#include "plumb/slam/io/cloud_file.hpp"
#include "plumb/slam/trajectory_error.hpp"

namespace plumb {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double near = 6;             // [m]
constexpr double far = 30;             // [m] of path
constexpr double part_of_path = 0.25;  // instead of far on short paths
constexpr std::size_t poses_asked = 150;
constexpr std::size_t most_revisits = 60;
constexpr std::size_t points_asked = 2000;
constexpr double share_of_overlap = 0.8;

Cloud points_of(const std::filesystem::path& file) {
  Cloud cloud = read_cloud(file).cloud;
  if (cloud.empty())
    throw Error(file.string() +
                ": holds no point, so nothing can be compared with it: leave --clouds out");
  return cloud;
}

/// Distance from `p` to the nearest point of `cloud`: candidates found in float, compared in
/// double.
double distance_to(const Cloud& cloud, const SearchTree& tree, const Eigen::Vector3d& p) {
  std::array<SearchTree::Neighbour, 4> candidates;
  const auto count = tree.nearest(p.cast<float>(), candidates.size(), candidates.data());
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < count; ++k)
    least = std::min(least, (cloud.point(candidates[k].index).cast<double>() - p).squaredNorm());
  return std::sqrt(least);
}

/// Root mean square of the distances below their quantile; NaN if none is below.
double rms_of_lower(const std::vector<double>& distances) {
  const double limit = quantile(distances, share_of_overlap);
  double sum = 0, count = 0;
  for (const double d : distances)
    if (d < limit) {
      sum += d * d;
      ++count;
    }
  return count > 0 ? std::sqrt(sum / count) : nan;
}

double gap(const Cloud& a, const Cloud& b, const SearchTree& tree_of_b, const Pose& T_b_a) {
  const Eigen::Matrix3d r = T_b_a.matrix();
  std::vector<double> distances;
  const std::size_t stride = std::max<std::size_t>(1, a.size() / points_asked);
  for (std::size_t k = 0; k < a.size(); k += stride)
    distances.push_back(
        distance_to(b, tree_of_b, r * a.point(k).cast<double>() + T_b_a.translation));
  return rms_of_lower(distances);
}

double median(const std::vector<double>& values) {
  for (const double value : values)
    if (std::isnan(value)) return nan;
  return quantile(values, 0.5);
}

}  // namespace

std::vector<Revisit> revisits_of(const std::vector<Pose>& truth) {
  std::vector<Revisit> revisits;
  if (truth.empty()) return revisits;
  const auto path = path_of(truth);
  const double least_path = std::min(far, path.back() * part_of_path);
  const std::size_t stride = std::max<std::size_t>(1, truth.size() / poses_asked);
  for (std::size_t i = 0; i < truth.size() && revisits.size() < most_revisits; i += stride) {
    std::optional<std::size_t> best;
    double least = near;
    for (std::size_t j = i; j < truth.size(); ++j) {
      if (!(path[j] - path[i] > least_path)) continue;
      const double distance = (truth[i].translation - truth[j].translation).norm();
      if (!(distance < least)) continue;
      least = distance;
      best = j;
    }
    if (best) revisits.push_back({i, *best});
  }
  return revisits;
}

Ghosting ghosting(const std::vector<std::filesystem::path>& frames,
                  const std::vector<Pose>& estimate, const std::vector<Pose>& truth) {
  const auto revisits = revisits_of(truth);
  const auto gaps = revisit_gaps(frames, revisits, {&estimate, &truth});
  return {median(gaps[0]), median(gaps[1]), revisits.size()};
}

std::vector<std::vector<double>> revisit_gaps(const std::vector<std::filesystem::path>& frames,
                                              const std::vector<Revisit>& revisits,
                                              const std::vector<const std::vector<Pose>*>& poses) {
  std::vector<std::vector<double>> gaps(poses.size(), std::vector<double>(revisits.size()));
  parallel_for(revisits.size(), [&](std::size_t k) {
    const auto [i, j] = revisits[k];
    const Cloud a = points_of(frames.at(i)), b = points_of(frames.at(j));
    const SearchTree tree(b);
    for (std::size_t set = 0; set < poses.size(); ++set)
      gaps[set][k] = gap(a, b, tree, (*poses[set])[j].inverse() * (*poses[set])[i]);
  });
  return gaps;
}

double quantile(std::vector<double> values, double q) {
  if (values.empty()) return nan;
  const double place = static_cast<double>(values.size() - 1) * q;
  const auto below = std::min(static_cast<std::size_t>(place), values.size() - 1);
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(below);
  std::nth_element(values.begin(), at, values.end());
  if (below + 1 == values.size()) return *at;
  const double a = *at, b = *std::min_element(at + 1, values.end());
  const double t = place - static_cast<double>(below);
  return t < 0.5 ? a + (b - a) * t : b - (b - a) * (1 - t);  // exact at both ends
}

}  // namespace plumb
