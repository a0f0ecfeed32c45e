#pragma once
/// Which frames of a sequence are used: the parameters that all sources of frames share.

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "plumb/slam/trajectory.hpp"

namespace plumb::io {

/// All frames, but for some that are left out to see how much a result depends on where a sequence
/// begins and on single frames.
struct FrameSelection {
  std::uint32_t skip_frames = 0;
  double drop_frames = 0;  ///< share of those behind the skipped ones, 0 to 1
  std::uint32_t drop_seed = 0;

  template <class Declare>
  static void describe(Declare& is) {
    is.param("skip_frames", &FrameSelection::skip_frames)
        .doc("frames left out at the beginning: the drift starts at the next one");
    is.param("drop_frames", &FrameSelection::drop_frames)
        .unit("%")
        .range(0, 0.9)
        .doc("share of the frames that is left out, each drawn by itself");
    is.param("drop_seed", &FrameSelection::drop_seed)
        .doc("seed of that draw: the same seed leaves out the same frames");
  }

  bool all() const { return skip_frames == 0 && drop_frames == 0; }

  /// Indices of the frames that are used, of `frames` that there are, rising. Whether one is
  /// dropped depends on its index and the seed alone, so that a larger share drops the same ones
  /// and more. Throws Error when fewer than two are left; `of` says of what: "my_run".
  std::vector<std::size_t> indices(std::size_t frames, const std::string& of) const;
};

/// The elements with these indices, which rise.
template <class T>
std::vector<T> selected(std::vector<T> all, const std::vector<std::size_t>& indices) {
  for (std::size_t k = 0; k < indices.size(); ++k)
    if (indices[k] != k) all[k] = std::move(all[indices[k]]);
  all.erase(all.begin() + static_cast<std::ptrdiff_t>(indices.size()), all.end());
  return all;
}

/// The poses with these indices.
inline Trajectory selected(Trajectory all, const std::vector<std::size_t>& indices) {
  all.stamps = selected(std::move(all.stamps), indices);
  all.T_world_frame = selected(std::move(all.T_world_frame), indices);
  return all;
}

}  // namespace plumb::io
