#include "by_count.hpp"

#include <algorithm>
#include <cmath>

namespace plumb::segment_by_count {

std::vector<std::size_t> starts_by_count(std::size_t frames, std::size_t per_segment,
                                         double phase) {
  const auto missing =
      static_cast<std::size_t>(std::lround(phase * static_cast<double>(per_segment)));
  std::vector<std::size_t> starts;
  if (frames > 0) starts.push_back(0);
  for (std::size_t first = std::max<std::size_t>(per_segment - missing, 1); first < frames;
       first += per_segment)
    starts.push_back(first);
  if (starts.size() > 1 && 2 * (frames - starts.back()) < per_segment) starts.pop_back();
  return starts;
}

std::size_t frames_for(std::size_t frames, std::size_t segments) {
  return std::max<std::size_t>(1, (frames + segments - 1) / segments);
}

}  // namespace plumb::segment_by_count
