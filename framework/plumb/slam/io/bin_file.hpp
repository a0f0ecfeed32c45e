#pragma once
/// Clouds as KITTI and MulRan store them: nothing but four float32 a point, x y z [m] and
/// intensity, little endian.

#include <filesystem>

#include "plumb/slam/io/cloud_file.hpp"

namespace plumb {

/// Reads a .bin file. Points with a non-finite coordinate are dropped and counted.
/// Throws Error: cannot be opened, a size that is not a multiple of 16 bytes (cut short).
CloudFile read_bin(const std::filesystem::path& file);

}  // namespace plumb
