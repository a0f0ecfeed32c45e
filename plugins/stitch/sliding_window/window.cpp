#include "window.hpp"

#include <algorithm>

namespace plumb::stitch_sliding_window {

Windows sliding_windows(std::size_t count, const Edges* edges, std::size_t frames,
                        std::size_t after) {
  std::vector<std::uint8_t> takes_part(count, edges ? 0 : 1);
  if (edges)
    for (const Edge& e : edges->list) takes_part[e.i] = takes_part[e.j] = 1;
  Windows windows;
  std::vector<std::uint32_t> place(count);  // how many take part up to and with the scan
  for (std::uint32_t k = 0; k < count; ++k) {
    if (takes_part[k]) windows.members.push_back(k);
    place[k] = static_cast<std::uint32_t>(windows.members.size());
  }

  // Runs that no window reaches over: `start` is the first place of a place's run, `stop` the end
  // of it.
  const std::size_t n = windows.members.size();
  std::vector<std::uint8_t> goes_on(n, edges ? 0 : 1);
  if (edges)
    for (const Edge& e : edges->list)
      if (e.kind == EdgeKind::sequential && place[e.j] == place[e.i] + 1)
        goes_on[place[e.j] - 1] = 1;
  std::vector<std::uint32_t> start(n), stop(n);
  for (std::uint32_t p = 0; p < n; ++p) start[p] = p > 0 && goes_on[p] ? start[p - 1] : p;
  for (std::size_t p = n; p-- > 0;)
    stop[p] = p + 1 < n && goes_on[p + 1] ? stop[p + 1] : static_cast<std::uint32_t>(p + 1);

  windows.first.resize(count);
  windows.end.resize(count);
  for (std::size_t k = 0; k < count; ++k) {
    if (place[k] == 0) continue;  // nobody takes part yet
    const std::size_t newest = place[k] - 1;
    windows.first[k] = std::max(
        start[newest], static_cast<std::uint32_t>(newest + 1 > frames ? newest + 1 - frames : 0));
    windows.end[k] =
        static_cast<std::uint32_t>(std::min<std::size_t>(stop[newest], newest + 1 + after));
  }
  return windows;
}

void empty_short_ones(Windows& windows, std::size_t frames) {
  for (std::size_t k = 0; k < windows.first.size(); ++k)
    if (windows.end[k] - windows.first[k] < frames) windows.end[k] = windows.first[k];
}

}  // namespace plumb::stitch_sliding_window
