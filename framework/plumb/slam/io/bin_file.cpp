#include "plumb/slam/io/bin_file.hpp"

#include <bit>
#include <cmath>
#include <cstring>

#include "plumb/data/io/file_text.hpp"

namespace plumb {

static_assert(std::endian::native == std::endian::little);

CloudFile read_bin(const std::filesystem::path& file) {
  const io::FileBytes bytes(file);
  const std::string_view data = bytes.view();
  constexpr std::size_t point_size = 4 * sizeof(float);
  if (data.size() % point_size != 0)
    io::refuse(file,
               "has " + std::to_string(data.size()) +
                   " bytes, which is not a multiple of 16 (x y z intensity as float32), so it "
                   "is cut short or "
                   "of another format: copy it again");
  CloudFile result;
  Cloud& cloud = result.cloud;
  const std::size_t points = data.size() / point_size;
  cloud.reserve(points);
  cloud.intensity.reserve(points);
  for (std::size_t k = 0; k < points; ++k) {
    float v[4];
    std::memcpy(v, data.data() + k * point_size, point_size);
    if (std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2])) {
      cloud.add({v[0], v[1], v[2]});
      cloud.intensity.push_back(v[3]);
    } else {
      ++result.dropped;
    }
  }
  return result;
}

}  // namespace plumb
