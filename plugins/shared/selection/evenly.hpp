#pragma once
/// A few of many, evenly chosen.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace plumb::selection {

/// Of the indices 0 .. count-1 `most`, evenly spaced from 0 on; all where there are no more.
inline std::vector<std::uint32_t> evenly(std::size_t count, std::size_t most) {
  const std::size_t n = std::min(count, most);
  std::vector<std::uint32_t> chosen(n);
  for (std::size_t k = 0; k < n; ++k) chosen[k] = static_cast<std::uint32_t>(k * count / n);
  return chosen;
}

}  // namespace plumb::selection
