#include "shared/overlapping/lattice.hpp"

#include <bit>
#include <cmath>
#include <cstdint>

#include "plumb/data/error.hpp"
#include "plumb/data/short_number.hpp"

namespace plumb::overlapping {

Eigen::AlignedBox3d world_box(const Box& box, const Pose& T_world_segment) {
  if (box.empty()) return {};
  const Eigen::Vector3d low = box.low.cast<double>(), high = box.high.cast<double>();
  const Eigen::Vector3d centre = T_world_segment * Eigen::Vector3d(0.5 * (low + high));
  const Eigen::Vector3d reach = T_world_segment.matrix().cwiseAbs() * (0.5 * (high - low));
  return {centre - reach, centre + reach};
}

Lattice lattice_over(const std::vector<Eigen::AlignedBox3d>& boxes, double size) {
  Eigen::AlignedBox3d all;
  for (const auto& box : boxes) all.extend(box);
  if (all.isEmpty()) return {size, Eigen::Vector3d::Zero(), 1};
  const Eigen::Vector3d first =
      (all.min() / size).array().floor() - 1;  // one to spare for rounding
  const double longest = ((all.max() / size).array().floor() + 2 - first.array()).maxCoeff();
  if (!(longest <= 1 << most_bits))
    throw Error("the segments reach over " + short_number(all.sizes().maxCoeff()) +
                " m, too far for voxels of " + short_number(size) +
                " m: take a larger 'resolution', or see whether the poses are right");
  return {size, size * first,
          static_cast<int>(std::bit_width(static_cast<std::uint32_t>(longest)))};
}

}  // namespace plumb::overlapping
