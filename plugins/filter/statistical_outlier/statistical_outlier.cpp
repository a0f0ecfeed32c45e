#include "statistical_outlier.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "compact_groups.hpp"
#include "sum_of_nearest.hpp"

namespace plumb::filter_statistical_outlier {

namespace {

constexpr std::size_t group_size = 8;

/// Mean distances of a few near points at a time, which share one search.
///
/// With c the middle of the block, h its farthest point's distance from c and r the distance of c's
/// last wanted neighbour: each point p of the block has its wanted neighbours within r + |p - c| of
/// p, so all of them lie within r + 2h of c.
class GroupSearch {
 public:
  GroupSearch(const Cloud& cloud, const SearchTree& tree, std::size_t mean_k)
      : cloud_(cloud), tree_(tree), wanted_(mean_k + 1), nearest_(wanted_) {}

  void means_of(std::span<const std::uint32_t> group, float* means) {
    Box box;
    for (const auto k : group) box.add(cloud_.point(k));
    const Eigen::Vector3f c = box.centre();
    float h = 0;
    for (const auto k : group) h = std::max(h, (cloud_.point(k) - c).norm());
    const std::size_t n = tree_.nearest(c, wanted_, nearest_.data());
    const float r = std::sqrt(nearest_[n - 1].squared_distance);
    // A block with much air in it would have to look at too many points; so would all points of a
    // cloud that is too small.
    if (n < wanted_ || h > 1.5f * r) {
      for (const auto k : group) means[k] = alone(cloud_.point(k));
      return;
    }
    gather(c, safely * (r + 2 * h));
    for (const auto k : group) {
      const Eigen::Vector3f p = cloud_.point(k);
      for (std::size_t i = 0; i < x_.size(); ++i) {
        const float dx = x_[i] - p.x(), dy = y_[i] - p.y(), dz = z_[i] - p.z();
        squares_[i] = (dx * dx + dy * dy) + dz * dz;
      }
      const float reach = safely * (r + (p - c).norm());
      // The point itself is one of those wanted, at distance 0.
      means[k] = sum_of_nearest(squares_.data(), squares_.size(), wanted_, reach * reach) /
                 static_cast<float>(wanted_ - 1);
    }
  }

 private:
  static constexpr float safely = 1.001f;  ///< far more than rounding can do

  float alone(const Eigen::Vector3f& p) {
    const std::size_t n = tree_.nearest(p, wanted_, nearest_.data());
    float sum = 0;
    for (std::size_t i = 1; i < n; ++i) sum += std::sqrt(nearest_[i].squared_distance);
    return n > 1 ? sum / static_cast<float>(n - 1) : 0;
  }
  void gather(const Eigen::Vector3f& c, float radius) {
    tree_.within(c, radius, found_, false);
    const std::size_t n = found_.size();
    for (auto* array : {&x_, &y_, &z_, &squares_}) array->resize(n);
    for (std::size_t i = 0; i < n; ++i) {
      x_[i] = cloud_.x[found_[i].index];
      y_[i] = cloud_.y[found_[i].index];
      z_[i] = cloud_.z[found_[i].index];
    }
  }

  const Cloud& cloud_;
  const SearchTree& tree_;
  std::size_t wanted_;
  std::vector<SearchTree::Neighbour> nearest_, found_;
  std::vector<float> x_, y_, z_, squares_;
};

}  // namespace

std::vector<float> mean_distances(const Cloud& cloud, const SearchTree& tree, std::size_t mean_k,
                                  const parallel::Loop& parallel) {
  constexpr std::size_t task = 512 * group_size;  // points
  const std::vector<std::uint32_t> order = compact_groups(cloud, group_size);
  std::vector<float> means(cloud.size());
  parallel((order.size() + task - 1) / task, [&](std::size_t t) {
    GroupSearch search(cloud, tree, mean_k);
    const std::size_t end = std::min(order.size(), (t + 1) * task);
    for (std::size_t k = t * task; k < end; k += group_size)
      search.means_of(std::span(order).subspan(k, std::min(group_size, end - k)), means.data());
  });
  return means;
}

std::vector<std::uint32_t> not_beyond(const std::vector<float>& values, double stddev_mul_thresh) {
  const double n = static_cast<double>(values.size());
  double sum = 0, squares = 0;
  for (const float v : values) sum += v;
  const double mean = sum / n;
  for (const float v : values) squares += (v - mean) * (v - mean);
  const double limit = mean + stddev_mul_thresh * std::sqrt(squares / std::max(1.0, n - 1));
  std::vector<std::uint32_t> kept;
  kept.reserve(values.size());
  for (std::size_t k = 0; k < values.size(); ++k)
    if (values[k] <= limit) kept.push_back(static_cast<std::uint32_t>(k));
  return kept;
}

}  // namespace plumb::filter_statistical_outlier
