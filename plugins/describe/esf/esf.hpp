#pragma once
/// Ensemble of shape functions: one vector of 640 numbers for the shape of a whole cloud.

#include <cstdint>
#include <optional>
#include <vector>

#include "plumb/slam/cloud.hpp"

namespace plumb::describe_esf {

inline constexpr std::size_t esf_bins = 64;  ///< of each of the ten histograms
inline constexpr std::size_t esf_size = 640;

/// The ESF of `cloud`, from `samples` random triples of points; the numbers sum to 1. The cloud is
/// moved to its centroid and scaled into a sphere of radius 32 cells of a 64^3 grid, in which a
/// cell is solid if it or one of its 26 neighbours holds a point. Of every triple are counted,
/// apart for lines that run in solid cells, outside of them, or both:
///   A3  the three angles                (histograms 0-2: in, out, mixed)
///   D3  the root of the triangle's area (3-5)
///   D2  the three distances             (6-8), and of mixed lines the share that is solid (9)
/// The same cloud and seed give the same bytes. Nothing if no three points of finite coordinates
/// span a triangle (of at least 1e-3 squared cells squared by Heron), or if they are so rare that
/// 100 tries a sample do not find enough. Source: [Wohlkinger2011]; grid, bins, weights and
/// thresholds as in PCL.
std::optional<std::vector<float>> esf(const Cloud& cloud, std::uint32_t samples,
                                      std::uint64_t seed);

}  // namespace plumb::describe_esf
