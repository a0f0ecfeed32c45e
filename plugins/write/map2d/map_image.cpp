#include "map_image.hpp"

#include <png.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "plumb/data/error.hpp"

namespace plumb::write_map2d {
namespace {

constexpr std::uint8_t unknown = 205;

template <class Grey>
GreyImage painted(const GridMap& map, const Grey& grey) {
  GreyImage image{map.columns, map.rows, std::vector<std::uint8_t>(map.log_odds.size())};
  for (std::size_t row = 0; row < map.rows; ++row) {
    const float* from = map.log_odds.data() + (map.rows - 1 - row) * map.columns;
    std::uint8_t* to = image.pixels.data() + row * map.columns;
    for (std::size_t c = 0; c < map.columns; ++c) to[c] = from[c] == 0 ? unknown : grey(from[c]);
  }
  return image;
}

std::string text_of(double value) {
  std::array<char, 32> text;
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  return {text.data(), end};
}

}  // namespace

double probability(float log_odds) { return 1 / (1 + std::exp(-double{log_odds})); }

GreyImage decided(const GridMap& map, const Thresholds& thresholds) {
  const auto log_odds = [](double p) { return std::log(p / (1 - p)); };
  const double occupied = log_odds(thresholds.occupied), free = log_odds(thresholds.free);
  return painted(map, [&](float v) -> std::uint8_t {
    return v > occupied ? 0 : v < free ? 254 : unknown;
  });
}

GreyImage shaded(const GridMap& map) {
  return painted(map, [](float v) {
    const double p = probability(v);
    const double grey = p < 0.5 ? unknown + (255 - unknown) * std::min(1.0, (0.5 - p) / 0.35)
                                : 2 * unknown * (1 - p);
    return static_cast<std::uint8_t>(std::lround(grey));
  });
}

std::string pgm_bytes(const GreyImage& image) {
  std::string bytes =
      "P5\n" + std::to_string(image.width) + " " + std::to_string(image.height) + "\n255\n";
  bytes.append(reinterpret_cast<const char*>(image.pixels.data()), image.pixels.size());
  return bytes;
}

std::string png_bytes(const GreyImage& image) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  png.width = image.width;
  png.height = image.height;
  png.format = PNG_FORMAT_GRAY;
  std::string bytes(PNG_IMAGE_PNG_SIZE_MAX(png), '\0');
  png_alloc_size_t size = bytes.size();
  if (!png_image_write_to_memory(&png, bytes.data(), &size, 0, image.pixels.data(), 0, nullptr))
    throw Error(std::string("the map cannot be written as PNG: ") + png.message);
  bytes.resize(size);
  return bytes;
}

std::string map_yaml(const GridMap& map, const std::string& image, const Thresholds& thresholds) {
  return "image: " + image + "\nmode: trinary\nresolution: " + text_of(map.resolution) +
         "\norigin: [" + text_of(map.origin.x()) + ", " + text_of(map.origin.y()) +
         ", 0.0]\nnegate: 0\noccupied_thresh: " + text_of(thresholds.occupied) +
         "\nfree_thresh: " + text_of(thresholds.free) + "\n";
}

}  // namespace plumb::write_map2d
