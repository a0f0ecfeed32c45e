#pragma once
/// Which scans make up the submap of each one.

#include <vector>

#include "plumb/slam/graph.hpp"

namespace plumb::stitch_sliding_window {

/// Submap k is made of the scans members[first[k] .. end[k]-1], which rise.
struct Windows {
  std::vector<std::uint32_t> members;     ///< scans that take part, in order
  std::vector<std::uint32_t> first, end;  ///< of each scan's submap, places in `members`
};

/// For each of `count` scans the last `frames` that take part up to it, itself included if it does,
/// and the next `after`. Without edges all take part. With them those do that an edge touches, and
/// a window does not extend across a restart: where a scan is joined to the one
/// before that takes part by no edge of kind sequential.
Windows sliding_windows(std::size_t count, const Edges* edges, std::size_t frames,
                        std::size_t after);

/// Empties the windows of fewer than `frames` scans. Source: [Zhang2023] 2 merges full ones only.
void empty_short_ones(Windows& windows, std::size_t frames);

}  // namespace plumb::stitch_sliding_window
