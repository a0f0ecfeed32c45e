#include "plumb/slam/io/frame_selection.hpp"

#include "plumb/data/counted.hpp"
#include "plumb/data/error.hpp"
#include "plumb/data/random.hpp"

namespace plumb::io {
namespace {

/// Uniform in [0, 1), of each pair of seed and frame its own.
double draw(std::uint32_t seed, std::size_t frame) {
  return Random(Random(seed).next() + frame).uniform();
}

}  // namespace

std::vector<std::size_t> FrameSelection::indices(std::size_t frames, const std::string& of) const {
  std::vector<std::size_t> kept;
  for (std::size_t k = skip_frames; k < frames; ++k)
    if (drop_frames == 0 || draw(drop_seed, k) >= drop_frames) kept.push_back(k);
  if (kept.size() < 2)
    throw Error(of + ": has " + counted(frames, "frames") + ", of which skip_frames and " +
                "drop_frames leave " + std::to_string(kept.size()) +
                ", but at least 2 are needed: leave fewer out");
  return kept;
}

}  // namespace plumb::io
