#pragma once
/// A grid map as images, and the description that ROS' map_server reads with them.

#include <string>
#include <vector>

#include "plumb/slam/values.hpp"

namespace plumb::write_map2d {

/// Probabilities at which a cell is called occupied or free; between them, and never seen, it is
/// unknown.
struct Thresholds {
  double occupied = 0.65, free = 0.196;
};

/// Grey values, the top row first (largest y), so that the map lies as on paper.
struct GreyImage {
  std::uint32_t width = 0, height = 0;
  std::vector<std::uint8_t> pixels;
};

/// Probability that a cell with these log odds is occupied.
double probability(float log_odds);

/// Three values, as map_saver writes them: 0 occupied, 254 free, 205 unknown.
GreyImage decided(const GridMap& map, const Thresholds& thresholds);

/// For looking at: by probability from white (15 % and below) over 205 (even, or never seen) to
/// black (certainly occupied).
GreyImage shaded(const GridMap& map);

/// Binary PGM (P5).
std::string pgm_bytes(const GreyImage& image);

/// PNG, 8 bits grey. Throws Error when libpng does.
std::string png_bytes(const GreyImage& image);

/// The YAML beside the image: image, mode, resolution, origin, negate, occupied_thresh,
/// free_thresh. Numbers read back as the same.
std::string map_yaml(const GridMap& map, const std::string& image, const Thresholds& thresholds);

}  // namespace plumb::write_map2d
