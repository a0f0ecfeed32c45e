#include "support.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace plumb::describe_fpfh {
namespace {

constexpr std::int64_t reach = 2;  // cells a neighbour may be away: their edge is half the radius

bool has_place_and_normal(const Cloud& cloud, std::size_t k) {
  const Eigen::Vector3f normal = cloud.normal(k);
  return cloud.point(k).allFinite() && normal.allFinite() && !normal.isZero();
}

}  // namespace

Support::Support(const Cloud& cloud, double radius) {
  if (!cloud.has_normals()) return;
  Box box;
  std::vector<std::uint32_t> usable;
  for (std::size_t k = 0; k < cloud.size(); ++k)
    if (has_place_and_normal(cloud, k)) {
      box.add(cloud.point(k));
      usable.push_back(static_cast<std::uint32_t>(k));
    }
  if (usable.empty()) return;

  // Cells of half the radius, or coarser if there were too many to count.
  const Eigen::Vector3d low = box.low.cast<double>();
  const Eigen::Vector3d extent = box.high.cast<double>() - low;
  double edge = 0.5 * radius * (1 + 1e-6);
  while (extent.maxCoeff() / edge > 2e6) edge *= 2;
  std::array<std::uint64_t, 3> cells_along;
  for (int c = 0; c < 3; ++c)
    cells_along[c] = static_cast<std::uint64_t>(extent[c] / edge) + 1 + 2 * reach;
  step_y_ = cells_along[2];
  step_x_ = cells_along[1] * step_y_;

  struct Keyed {
    std::uint64_t key;
    std::uint32_t index;
    bool operator<(const Keyed& other) const {
      return key < other.key || (key == other.key && index < other.index);
    }
  };
  std::vector<Keyed> keyed;
  keyed.reserve(usable.size());
  for (const auto k : usable) {
    const Eigen::Vector3d at = (cloud.point(k).cast<double>() - low) / edge;
    const auto cell = [&](int c) { return static_cast<std::uint64_t>(at[c]) + reach; };
    keyed.push_back({cell(0) * step_x_ + cell(1) * step_y_ + cell(2), k});
  }
  std::sort(keyed.begin(), keyed.end());

  const auto count = keyed.size();
  for (auto* array : {&x, &y, &z, &nx, &ny, &nz}) array->resize(count);
  index.resize(count);
  for (std::uint32_t place = 0; place < count; ++place) {
    const auto k = keyed[place].index;
    x[place] = cloud.x[k], y[place] = cloud.y[k], z[place] = cloud.z[k];
    nx[place] = cloud.nx[k], ny[place] = cloud.ny[k], nz[place] = cloud.nz[k];
    index[place] = k;
    if (cells_.empty() || cells_.back().key != keyed[place].key)
      cells_.push_back({keyed[place].key, place, place});
    cells_.back().end = place + 1;
  }
}

std::vector<std::size_t> Support::blocks(std::size_t points) const {
  std::vector<std::size_t> starts{0};
  for (std::size_t c = 0; c < cells_.size(); ++c)
    if (cells_[c].end - cells_[starts.back()].first >= points) starts.push_back(c + 1);
  if (starts.back() != cells_.size()) starts.push_back(cells_.size());
  return starts;
}

const Candidates& CandidateFinder::around(const Support::Cell& cell) {
  const auto& cells = support_.cells();
  const auto key_before = [](const Support::Cell& c, std::uint64_t key) { return c.key < key; };
  if (columns_.empty()) {
    for (std::int64_t dx = -reach; dx <= reach; ++dx)
      for (std::int64_t dy = -reach; dy <= reach; ++dy) {
        const auto offset = dx * static_cast<std::int64_t>(support_.step_x_) +
                            dy * static_cast<std::int64_t>(support_.step_y_);
        const auto lowest = cell.key + static_cast<std::uint64_t>(offset - reach);
        const auto at = std::lower_bound(cells.begin(), cells.end(), lowest, key_before);
        const auto start = static_cast<std::size_t>(at - cells.begin());
        columns_.push_back({offset, start, start});
      }
  }
  // Keys ascend, so each column's range only moves on.
  Candidates& to = candidates_;
  to.size = 0;
  for (auto& column : columns_) {
    const auto low = cell.key + static_cast<std::uint64_t>(column.offset - reach);
    while (column.first < cells.size() && cells[column.first].key < low) ++column.first;
    column.end = std::max(column.end, column.first);
    while (column.end < cells.size() && cells[column.end].key <= low + 2 * reach) ++column.end;
    if (column.first < column.end) to.size += cells[column.end - 1].end - cells[column.first].first;
  }
  const std::size_t used = to.size;
  to.size = (used + Candidates::lanes - 1) / Candidates::lanes * Candidates::lanes;
  if (to.x.size() < to.size) {
    for (auto* array : {&to.x, &to.y, &to.z, &to.nx, &to.ny, &to.nz}) array->resize(2 * to.size);
    to.place.resize(2 * to.size);
  }
  std::size_t filled = 0;
  for (const auto& column : columns_) {
    if (column.first == column.end) continue;
    const auto first = cells[column.first].first, end = cells[column.end - 1].end;
    const auto copy = [&](const std::vector<float>& from, std::vector<float>& into) {
      std::copy(from.begin() + first, from.begin() + end, into.begin() + static_cast<long>(filled));
    };
    copy(support_.x, to.x), copy(support_.y, to.y), copy(support_.z, to.z);
    copy(support_.nx, to.nx), copy(support_.ny, to.ny), copy(support_.nz, to.nz);
    for (auto place = first; place < end; ++place) to.place[filled + (place - first)] = place;
    filled += end - first;
  }
  for (; filled < to.size; ++filled) {
    to.x[filled] = to.y[filled] = to.z[filled] = std::numeric_limits<float>::infinity();
    to.nx[filled] = to.ny[filled] = to.nz[filled] = 0;
    to.place[filled] = 0;
  }
  return to;
}

}  // namespace plumb::describe_fpfh
