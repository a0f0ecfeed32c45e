#include "by_distance.hpp"

#include <algorithm>

namespace plumb::segment_by_distance {

double grown_length(double path, double length, std::optional<double> max_length,
                    std::size_t max_segments) {
  return std::clamp(path / static_cast<double>(max_segments), length,
                    std::max(length, max_length.value_or(length)));
}

std::vector<std::size_t> starts_by_distance(
    const std::vector<double>& travelled, double length, std::optional<std::size_t> max_frames,
    const std::function<bool(std::size_t, std::size_t)>& breaks, double phase) {
  std::vector<std::size_t> starts;
  for (std::size_t k = 0; k < travelled.size(); ++k) {
    const bool full = !starts.empty() && max_frames && k - starts.back() >= *max_frames;
    const bool broken = !starts.empty() && breaks && breaks(starts.back(), k);
    const double longest = starts.size() == 1 ? (1 - phase) * length : length;
    if (starts.empty() || full || broken || travelled[k] - travelled[starts.back()] > longest)
      starts.push_back(k);
  }
  if (starts.size() < 2) return starts;
  const std::size_t last = starts.back(), before = starts[starts.size() - 2];
  const bool short_path = travelled.back() - travelled[last] < 0.5 * length;
  const bool few_frames = !max_frames || 2 * (travelled.size() - last) < *max_frames;
  const bool fits = travelled.back() - travelled[before] < 2 * length;
  const bool parted = breaks && breaks(before, travelled.size() - 1);
  if (short_path && few_frames && fits && !parted) starts.pop_back();
  return starts;
}

}  // namespace plumb::segment_by_distance
