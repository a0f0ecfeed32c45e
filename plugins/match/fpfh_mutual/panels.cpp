#include "panels.hpp"

#include <algorithm>
#include <cmath>

#include "plumb/slam/geometry/symmetric.hpp"

namespace plumb::match_fpfh_mutual {
namespace {

constexpr std::size_t sample = 1024;  // vectors of each set that the axes are taken from
constexpr float far = std::numeric_limits<float>::infinity();

bool usable(std::span<const float> vector) {
  double squared = 0;
  for (const float value : vector) squared += static_cast<double>(value) * value;
  return squared < static_cast<double>(std::numeric_limits<float>::max()) / 16;
}

float not_less(double value) {
  const auto near = static_cast<float>(value);
  return near >= value ? near : std::nextafter(near, far);
}

/// Orders places so that each run of `width` lies close together: halves along the widest of the
/// first axes, again and again.
void gather(std::vector<std::uint32_t>::iterator first, std::vector<std::uint32_t>::iterator last,
            const Eigen::MatrixXf& turned, std::size_t width) {
  const auto n = static_cast<std::size_t>(last - first);
  if (n <= width) return;
  const std::size_t axes =
      std::min<std::size_t>(Panels::box_axes, static_cast<std::size_t>(turned.rows()));
  float low[Panels::box_axes], high[Panels::box_axes];
  std::fill(low, low + axes, far);
  std::fill(high, high + axes, -far);
  for (auto at = first; at != last; ++at) {
    const float* vector = turned.col(*at).data();
    for (std::size_t c = 0; c < axes; ++c) {
      low[c] = std::min(low[c], vector[c]);
      high[c] = std::max(high[c], vector[c]);
    }
  }
  std::size_t widest = 0;
  for (std::size_t c = 1; c < axes; ++c)
    if (high[c] - low[c] > high[widest] - low[widest]) widest = c;
  const auto axis = static_cast<Eigen::Index>(widest);
  const auto middle = first + static_cast<long>((n / 2 + width - 1) / width * width);
  std::nth_element(first, middle, last, [&](std::uint32_t p, std::uint32_t q) {
    return turned(axis, p) < turned(axis, q) || (turned(axis, p) == turned(axis, q) && p < q);
  });
  gather(first, middle, turned, width);
  gather(middle, last, turned, width);
}

}  // namespace

PrincipalAxes::PrincipalAxes(std::span<const float> a, std::span<const float> b,
                             std::size_t dimension) {
  const auto d = static_cast<Eigen::Index>(dimension);
  std::vector<const float*> chosen;
  for (const auto set : {a, b}) {
    const std::size_t n = set.size() / dimension, step = std::max<std::size_t>(1, n / sample);
    for (std::size_t k = 0; k < n; k += step)
      if (usable(set.subspan(k * dimension, dimension))) chosen.push_back(&set[k * dimension]);
  }
  mean = Eigen::VectorXd::Zero(d);
  axes = Eigen::MatrixXd::Identity(d, d);
  if (chosen.empty()) return;
  Eigen::MatrixXd points(d, static_cast<Eigen::Index>(chosen.size()));
  for (std::size_t k = 0; k < chosen.size(); ++k)
    points.col(static_cast<Eigen::Index>(k)) =
        Eigen::Map<const Eigen::VectorXf>(chosen[k], d).cast<double>();
  mean = points.rowwise().mean();
  points.colwise() -= mean;
  const Eigen::MatrixXd spread = points * points.transpose();
  const auto eigen = symmetric_eigen(spread);
  if (eigen.converged) axes = eigen.vectors.rowwise().reverse();
}

Panels::Panels(std::span<const float> vectors, const PrincipalAxes& principal, std::size_t width)
    : width_(width), dimension_(static_cast<std::size_t>(principal.mean.size())) {
  const auto d = static_cast<Eigen::Index>(dimension_);
  std::vector<std::uint32_t> kept;
  for (std::size_t k = 0; k < vectors.size() / dimension_; ++k)
    if (usable(vectors.subspan(k * dimension_, dimension_)))
      kept.push_back(static_cast<std::uint32_t>(k));
  Eigen::MatrixXd points(d, static_cast<Eigen::Index>(kept.size()));
  for (std::size_t k = 0; k < kept.size(); ++k)
    points.col(static_cast<Eigen::Index>(k)) =
        Eigen::Map<const Eigen::VectorXf>(&vectors[kept[k] * dimension_], d).cast<double>() -
        principal.mean;
  const Eigen::MatrixXf turned = (principal.axes.transpose() * points).cast<float>();

  std::vector<std::uint32_t> order(kept.size());
  for (std::uint32_t k = 0; k < order.size(); ++k) order[k] = k;
  gather(order.begin(), order.end(), turned, width);

  count_ = (order.size() + width - 1) / width;
  values_.assign(count_ * width * dimension_, 0);
  index.assign(count_ * width, 0);
  norms.assign(count_ * width, far);
  head_norms.assign(count_ * width, far);
  limits.assign(count_ * width, -far);
  reach.assign(stride(), std::numeric_limits<float>::max());
  low.assign(stride() * box_axes, far);
  high.assign(stride() * box_axes, -far);
  // Turning to float and summing products in float are off by at most (dimension + 8) / 2^24 of the
  // sum of both squared lengths, each.
  const double shrink = 1 - static_cast<double>(dimension_ + 16) * 0x1.0p-23;
  const auto head = std::min<Eigen::Index>(head_axes, d);
  for (std::size_t place = 0; place < order.size(); ++place) {
    const auto vector = turned.col(order[place]);
    const std::size_t panel = place / width;
    for (std::size_t c = 0; c < dimension_; ++c)
      values_[(panel * dimension_ + c) * width + place % width] =
          vector[static_cast<Eigen::Index>(c)];
    for (std::size_t axis = 0; axis < box_axes; ++axis) {
      const float value = axis < dimension_ ? vector[static_cast<Eigen::Index>(axis)] : 0;
      float &lowest = low[axis * stride() + panel], &highest = high[axis * stride() + panel];
      lowest = std::min(lowest, value);
      highest = std::max(highest, value);
    }
    index[place] = kept[order[place]];
    norms[place] = static_cast<float>(vector.cast<double>().squaredNorm() * shrink);
    head_norms[place] = static_cast<float>(vector.head(head).cast<double>().squaredNorm() * shrink);
    limits[place] = std::numeric_limits<float>::max();
  }
}

void Panels::shorten(std::size_t place, double squared_distance) {
  limits[place] = not_less(squared_distance);
  const std::size_t panel = place / width_;
  reach[panel] = *std::max_element(&limits[panel * width_], &limits[panel * width_] + width_);
}

}  // namespace plumb::match_fpfh_mutual
