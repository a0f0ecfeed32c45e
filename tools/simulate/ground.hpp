#pragma once
/// The ground: one height function of the whole world, so that every pass of a place meets the same
/// street.

#include <Eigen/Core>
#include <vector>

#include "simulate/primitive.hpp"

namespace plumb::simulate {

/// A grid of heights [m]; between them two triangles a cell, split along the diagonal from low to
/// high corner.
class Ground {
 public:
  Ground() = default;
  /// `heights` in rows of `columns`, x first; sample (i, j) stands at low + cell * (i, j).
  Ground(const Eigen::Vector2f& low, float cell, int columns, int rows, std::vector<float> heights);

  /// Height at (x, y); beyond the grid, that of its border.
  float height(float x, float y) const;

  /// Where `ray` goes under the ground, if that is nearer than `hit.t`; beyond the grid there is
  /// none.
  bool intersect(const Ray& ray, Hit& hit) const;

  int columns() const { return columns_; }
  int rows() const { return rows_; }
  Eigen::Vector3f sample(int i, int j) const {
    return {low_.x() + cell_ * static_cast<float>(i), low_.y() + cell_ * static_cast<float>(j),
            at(i, j)};
  }

 private:
  float at(int i, int j) const {
    return heights_[static_cast<std::size_t>(j) * static_cast<std::size_t>(columns_) +
                    static_cast<std::size_t>(i)];
  }
  bool intersect_cell(const Ray& ray, int i, int j, float t0, float t1, Hit& hit) const;

  Eigen::Vector2f low_ = Eigen::Vector2f::Zero();
  float cell_ = 1;
  int columns_ = 0, rows_ = 0;
  int block_columns_ = 0;
  std::vector<float> heights_;
  std::vector<float>
      block_top_;  ///< greatest height in each block of cells: what a ray must dip under
};

/// The ground under the points `path` (about one a metre; x, y and the ground's z there [m]), with
/// `margin` [m] around: near the path a mean of the nearby points' heights, a few metres smooth, so
/// that passes that disagree share one street; farther away an ever smoother one. Beyond `kerb` [m]
/// from every point a pavement 0.12 m higher, then uneven land, grown from `seed`; `unevenness` 0
/// keeps it even.
Ground ground_under(const std::vector<Eigen::Vector3f>& path, float kerb, float margin,
                    std::uint64_t seed, float unevenness = 1);

}  // namespace plumb::simulate
