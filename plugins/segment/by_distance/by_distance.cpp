#include "by_distance.hpp"

namespace plumb {

std::vector<std::size_t> starts_by_distance(const std::vector<double>& travelled, double length,
                                            std::optional<std::size_t> most_frames) {
  std::vector<std::size_t> starts;
  for (std::size_t k = 0; k < travelled.size(); ++k) {
    const bool full = !starts.empty() && most_frames && k - starts.back() >= *most_frames;
    if (starts.empty() || full || travelled[k] - travelled[starts.back()] > length)
      starts.push_back(k);
  }
  if (starts.size() < 2) return starts;
  const bool short_path = travelled.back() - travelled[starts.back()] < 0.5 * length;
  const bool few_frames = !most_frames || 2 * (travelled.size() - starts.back()) < *most_frames;
  if (short_path && few_frames) starts.pop_back();
  return starts;
}

}  // namespace plumb
