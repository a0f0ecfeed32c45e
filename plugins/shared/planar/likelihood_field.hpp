#pragma once
/// How likely it is to see a point at a place of the plane, given points seen before; and bounds of
/// that over squares of cells.

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <vector>

namespace plumb::planar {

/// Values 0 to 255 on a grid: 255 exp(-d^2 / (2 sigma^2)), d the distance of the cell's middle to
/// the nearest point. Level n holds, for each cell, the largest value in the square of 2^n x 2^n
/// cells that begins there, so that a score from level n is an upper bound.
/// Source: [Olson2009] (the field), [Hess2016] (the levels).
class LikelihoodField {
 public:
  /// Of points x, y [m]; `margin` [m] is added round their box. Throws
  /// std::length_error where the grid would have more than 64 million cells.
  LikelihoodField(const std::vector<float>& x, const std::vector<float>& y, double resolution,
                  double sigma, double margin, int levels);

  double resolution() const { return resolution_; }
  int levels() const { return static_cast<int>(grids_.size()); }
  /// The cell (column, row) that a place lies in; it may lie outside the grid.
  Eigen::Array2i cell(double x, double y) const {
    return {static_cast<int>(std::floor((x - low_.x()) * per_metre_)),
            static_cast<int>(std::floor((y - low_.y()) * per_metre_))};
  }
  /// The largest value of the 2^level square that begins at the cell; 0 outside. A square that
  /// begins up to 2^level - 1 cells before the grid counts with the part that lies in it.
  std::uint8_t value(int level, int column, int row) const {
    const int before = (1 << level) - 1;
    const auto c = static_cast<unsigned>(column + before), r = static_cast<unsigned>(row + before);
    const auto width = static_cast<unsigned>(columns_ + before);
    if (c >= width || r >= static_cast<unsigned>(rows_ + before)) return 0;
    return grids_[level][static_cast<std::size_t>(r) * width + c];
  }

 private:
  void pool(int level);

  double resolution_, per_metre_;
  Eigen::Vector2d low_ = Eigen::Vector2d::Zero();
  int columns_ = 0, rows_ = 0;
  std::vector<std::vector<std::uint8_t>>
      grids_;  ///< level n is 2^n - 1 cells wider on the low sides
};

}  // namespace plumb::planar
