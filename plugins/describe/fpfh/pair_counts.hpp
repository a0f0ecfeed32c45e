#pragma once
/// The simplified point feature histogram (SPFH) of one point: how its normal stands to its
/// neighbours'.

#include <array>
#include <cstdint>

#include "support.hpp"

namespace plumb::describe_fpfh {

inline constexpr std::size_t fpfh_bins = 11;  ///< of each of the three angles

/// How many neighbours fall into each bin of theta, alpha and phi, in this order.
struct PairCounts {
  std::array<std::uint32_t, 3 * fpfh_bins> bins;
  std::uint32_t neighbours;  ///< within the radius, the point itself included
};

/// A point with its normal.
struct Oriented {
  float x, y, z, nx, ny, nz;
};

/// The three angles of a pair in its Darboux frame. With d = p2 - p1 [m] and unit normals n1, n2,
/// point 1 being the one whose normal is nearer to the line between both:
///   u = n1, v = d x u / |d x u|, w = u x v
///   alpha = v n2,  phi = u d / |d|,  theta = atan2(w n2, u n2)
/// Each is counted in 11 equal bins over [-1, 1], [-1, 1] and [-pi, pi]. A neighbour at the point's
/// own place, or straight along the normal u, has no frame and is not counted in a bin. Source:
/// [Rusu2009] II.A eq. 1, with the choice of point 1, the signs and the bins of PCL.
PairCounts count_pairs(const Oriented& point, const Candidates& candidates, float squared_radius);

/// The same pair by pair, as one reads it: for machines without AVX2, and to judge the other.
PairCounts count_pairs_plainly(const Oriented& point, const Candidates& candidates,
                               float squared_radius);

}  // namespace plumb::describe_fpfh
