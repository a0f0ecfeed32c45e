#pragma once
/// Fast point feature histograms: 33 numbers that say how the surface bends round a point.

#include <optional>

#include "plumb/plugin/context.hpp"
#include "plumb/slam/values.hpp"

namespace plumb::describe_fpfh {

struct FpfhOptions {
  double radius = 2.5;                          ///< [m] of a neighbourhood
  std::optional<std::uint32_t> max_neighbours;  ///< only so many of them, the nearest
  std::uint32_t min_neighbours = 10;            ///< a keypoint with fewer gets no feature
  double border_angle = 90 * deg;  ///< [rad] a wider gap between neighbours makes a border
};

struct Fpfh {
  Features features;                 ///< dimension 33
  std::vector<std::uint32_t> index;  ///< of each keypoint in the cloud
  std::size_t left_out = 0;          ///< keypoints with too few neighbours
};

/// Describes the points `keys` of `cloud`, in that order, the whole cloud being the support. Points
/// without normals are as if they were not there. With S(p) the counts of count_pairs divided by
/// the number of p's neighbours,
///   F(p) = sum over neighbours q of S(q) / |p - q|^2,
/// each of its three parts of 11 bins scaled to the sum 100. The result does not depend on the
/// number of threads. Source: [Rusu2009] II.B; weights and scale as in PCL (which leaves the
/// point's own S out).
Fpfh fpfh(const Cloud& cloud, const std::vector<std::uint32_t>& keys, const FpfhOptions& options,
          Context& context);

}  // namespace plumb::describe_fpfh
