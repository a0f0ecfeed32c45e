#include "solid_grid.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace plumb::describe_esf {

SolidGrid::SolidGrid(const std::vector<Eigen::Vector3f>& points) {
  for (const auto& point : points) {
    const Eigen::Vector3i cell = cell_of(point);
    // Three cells in a row along z, cut off at the grid's ends.
    const int low = std::max(cell.z() - 1, 0), high = std::min(cell.z() + 1, side - 1);
    const std::uint64_t row = (~std::uint64_t{0} >> (side - 1 - (high - low))) << low;
    for (int x = std::max(cell.x() - 1, 0); x <= std::min(cell.x() + 1, side - 1); ++x)
      for (int y = std::max(cell.y() - 1, 0); y <= std::min(cell.y() + 1, side - 1); ++y)
        bits_[static_cast<std::size_t>(x * side + y)] |= row;
  }
}

Eigen::Vector3i SolidGrid::cell_of(const Eigen::Vector3f& point) {
  Eigen::Vector3i cell;
  for (int c = 0; c < 3; ++c) {
    const float value = point[c];
    const float whole = value < 0 ? std::floor(value) : std::ceil(value) - 1;
    cell[c] = std::clamp(static_cast<int>(whole) + side / 2, 0, side - 1);
  }
  return cell;
}

Line SolidGrid::trace(const Eigen::Vector3i& from, const Eigen::Vector3i& to) const {
  // Axes in the order main, first, second; PCL prefers x to y to z as main where they tie.
  const Eigen::Vector3i span = (to - from).cwiseAbs();
  int axis[3] = {0, 1, 2};
  if (span.x() < span.y() || span.x() < span.z())
    axis[0] = span.y() >= span.z() ? 1 : 2, axis[axis[0]] = 0;
  const int steps = span[axis[0]];
  int error[3] = {0, 2 * span[axis[1]] - steps, 2 * span[axis[2]] - steps};
  int sign[3];
  for (int k = 0; k < 3; ++k) sign[k] = to[axis[k]] < from[axis[k]] ? -1 : 1;

  Eigen::Vector3i at = from;
  Line line{1, solid(at)};
  for (int step = 1; step < steps; ++step) {
    for (int k = 1; k < 3; ++k) {
      if (error[k] > 0) {
        at[axis[k]] += sign[k];
        error[k] -= 2 * steps;
      }
      error[k] += 2 * span[axis[k]];
    }
    at[axis[0]] += sign[0];
    ++line.cells;
    line.solid += solid(at);
  }
  return line;
}

}  // namespace plumb::describe_esf
