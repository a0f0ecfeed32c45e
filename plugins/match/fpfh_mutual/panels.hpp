#pragma once
/// Vectors turned, sorted and packed so that many comparisons can be left out and the rest run side
/// by side.

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace plumb::match_fpfh_mutual {

/// A turn of the axes (and a shift) after which the first coordinates tell the most: principal
/// axes. Distances stay what they are.
struct PrincipalAxes {
  Eigen::VectorXd mean;
  Eigen::MatrixXd axes;  ///< columns, by falling variance

  /// Of a sample of both sets, the same for the same vectors.
  PrincipalAxes(std::span<const float> a, std::span<const float> b, std::size_t dimension);
};

/// Vectors in panels of `width` that lie near each other. Vectors that are non-finite are
/// left out; unused places are so far away that they are never near.
class Panels {
 public:
  static constexpr std::size_t box_axes = 4;  ///< more make boxes no tighter (measured on FPFH)
  static constexpr std::size_t head_axes =
      8;  ///< compared first: for 97 % of FPFH pairs that is enough

  Panels(std::span<const float> vectors, const PrincipalAxes& principal, std::size_t width);

  std::size_t count() const { return count_; }
  std::size_t stride() const { return (count_ + 7) / 8 * 8; }
  std::size_t dimension() const { return dimension_; }
  /// Coordinates of panel k: of all its vectors the first one, then the second one, ...
  const float* values(std::size_t k) const { return &values_[k * width_ * dimension_]; }

  std::vector<std::uint32_t> index;  ///< of the vector at each place
  /// Squared length of each vector in all and in the first `head_axes` coordinates, a little less
  /// than it is: with them norm_i + norm_j - 2 a_i b_j, computed in float, is never greater than
  /// the squared distance.
  std::vector<float> norms, head_norms;
  std::vector<float> limits;  ///< squared distance of each vector's nearest so far, rounded up
  std::vector<float> reach;   ///< the largest limit of each panel

  /// low[axis * stride() + k] and high[...]: the box round panel k; at infinity beyond the last
  /// one, up to a multiple of 8.
  std::vector<float> low, high;

  void shorten(std::size_t place, double squared_distance);

 private:
  std::size_t width_, dimension_, count_ = 0;
  std::vector<float> values_;
};

}  // namespace plumb::match_fpfh_mutual
