#pragma once
/// Ghosting: how far apart a place seen twice comes out, judged by the clouds themselves.

#include <filesystem>
#include <vector>

#include "plumb/slam/geometry/pose.hpp"

namespace plumb {

/// Two frames that see the same place at different times.
struct Revisit {
  std::size_t first, second;
};

/// Pairs of poses less than 6 m apart that lie more than 30 m of path (or a quarter of the whole
/// path, if that is less) from each other: for about 150 poses, evenly chosen, the nearest such
/// later pose; the first 60 of these pairs.
std::vector<Revisit> revisits_of(const std::vector<Pose>& truth);

/// Ghosting under some poses [m].
struct Ghosting {
  double estimate;    ///< under the estimated poses
  double truth;       ///< under the true ones: what the clouds themselves are good for
  std::size_t pairs;  ///< revisits that it comes from; both numbers are NaN without any
};

/// For each revisit: distances from about 2000 evenly chosen points of the first frame to the
/// nearest point of the second, all placed by the poses; root mean square of those below their 80 %
/// quantile. Ghosting is the median of these over the revisits. `frames`, `estimate` and `truth`
/// correspond by index. Throws Error when a frame cannot be read or has no points.
Ghosting ghosting(const std::vector<std::filesystem::path>& frames,
                  const std::vector<Pose>& estimate, const std::vector<Pose>& truth);

/// The gap [m] of each revisit under several sets of poses, by set, then revisit: what Ghosting is
/// the median of. Each frame is read once. Errors as ghosting().
std::vector<std::vector<double>> revisit_gaps(const std::vector<std::filesystem::path>& frames,
                                              const std::vector<Revisit>& revisits,
                                              const std::vector<const std::vector<Pose>*>& poses);

/// The value below which a share `q` (0 to 1) of `values` lies, interpolated linearly between
/// neighbours; NaN for none.
double quantile(std::vector<double> values, double q);

}  // namespace plumb
