#include "shared/planar/likelihood_field.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace plumb::planar {

LikelihoodField::LikelihoodField(const std::vector<float>& x, const std::vector<float>& y,
                                 double resolution, double sigma, double margin, int levels)
    : resolution_(resolution), per_metre_(1 / resolution) {
  grids_.resize(static_cast<std::size_t>(levels));
  if (x.empty()) {
    for (int level = 1; level < levels; ++level)
      grids_[level].assign((1 << level) * (1 << level), 0);
    return;
  }
  const auto [x0, x1] = std::minmax_element(x.begin(), x.end());
  const auto [y0, y1] = std::minmax_element(y.begin(), y.end());
  low_ = {std::floor((*x0 - margin) * per_metre_) * resolution,
          std::floor((*y0 - margin) * per_metre_) * resolution};
  const double columns = std::ceil((*x1 + margin - low_.x()) * per_metre_) + 1;
  const double rows = std::ceil((*y1 + margin - low_.y()) * per_metre_) + 1;
  if (!(columns * rows < 64e6))
    throw std::length_error("a likelihood field of " + std::to_string(static_cast<long>(columns)) +
                            " x " + std::to_string(static_cast<long>(rows)) +
                            " cells is too large: raise the resolution, or drop far points");
  columns_ = static_cast<int>(columns), rows_ = static_cast<int>(rows);
  auto& fine = grids_[0];
  fine.assign(static_cast<std::size_t>(columns_) * rows_, 0);

  // The value depends on where in its cell the point lies: a kernel for each of 4 x 4 places.
  constexpr int parts = 4;
  const int reach = static_cast<int>(std::ceil(3 * sigma * per_metre_));
  const int side = 2 * reach + 1;
  std::vector<std::uint8_t> kernels(static_cast<std::size_t>(parts * parts * side * side));
  for (int p = 0; p < parts * parts; ++p)
    for (int r = 0; r < side; ++r)
      for (int c = 0; c < side; ++c) {
        const double dx = (c - reach + 0.5 - (p % parts + 0.5) / parts) * resolution;
        const double dy = (r - reach + 0.5 - (p / parts + 0.5) / parts) * resolution;
        kernels[(static_cast<std::size_t>(p) * side + r) * side + c] = static_cast<std::uint8_t>(
            std::lround(255 * std::exp(-0.5 * (dx * dx + dy * dy) / (sigma * sigma))));
      }
  for (std::size_t k = 0; k < x.size(); ++k) {
    const double u = (x[k] - low_.x()) * per_metre_, v = (y[k] - low_.y()) * per_metre_;
    const int column = static_cast<int>(u), row = static_cast<int>(v);
    const int part =
        static_cast<int>((v - row) * parts) * parts + static_cast<int>((u - column) * parts);
    const std::uint8_t* kernel = &kernels[static_cast<std::size_t>(part) * side * side];
    const int c0 = std::max(0, column - reach), c1 = std::min(columns_ - 1, column + reach);
    for (int r = std::max(0, row - reach); r <= std::min(rows_ - 1, row + reach); ++r) {
      std::uint8_t* line = &fine[static_cast<std::size_t>(r) * columns_];
      const std::uint8_t* from = kernel + (r - row + reach) * side - column + reach;
      for (int c = c0; c <= c1; ++c) line[c] = std::max(line[c], from[c]);
    }
  }
  for (int level = 1; level < levels; ++level) pool(level);
}

/// From the level below: the larger of two squares of half the size, along rows and then columns.
void LikelihoodField::pool(int level) {
  const int half = 1 << (level - 1), old_before = half - 1, before = 2 * half - 1;
  const int old_width = columns_ + old_before, old_height = rows_ + old_before;
  const int width = columns_ + before, height = rows_ + before;
  const auto& old = grids_[level - 1];
  std::vector<std::uint8_t> rows(static_cast<std::size_t>(width) * old_height, 0);
  for (int r = 0; r < old_height; ++r) {
    const std::uint8_t* from = &old[static_cast<std::size_t>(r) * old_width];
    std::uint8_t* to = &rows[static_cast<std::size_t>(r) * width];
    // Column c of the new level begins at cell c - before; its halves at old columns c - half and
    // c.
    for (int c = 0; c < old_width; ++c) to[c + half] = from[c];
    for (int c = 0; c < old_width; ++c) to[c] = std::max(to[c], from[c]);
  }
  auto& grid = grids_[level];
  grid.assign(static_cast<std::size_t>(width) * height, 0);
  for (int r = 0; r < old_height; ++r) {
    const std::uint8_t* from = &rows[static_cast<std::size_t>(r) * width];
    std::copy_n(from, width, &grid[static_cast<std::size_t>(r + half) * width]);
  }
  for (int r = 0; r < old_height; ++r) {
    const std::uint8_t* from = &rows[static_cast<std::size_t>(r) * width];
    std::uint8_t* to = &grid[static_cast<std::size_t>(r) * width];
    for (int c = 0; c < width; ++c) to[c] = std::max(to[c], from[c]);
  }
}

}  // namespace plumb::planar
