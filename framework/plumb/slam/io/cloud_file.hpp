#pragma once
/// Point clouds in files: PCD and PLY, read and written whole.

#include <cstdint>
#include <filesystem>
#include <string>

#include "plumb/slam/cloud.hpp"

namespace plumb {

/// A cloud as read, and how many of the file's points were left out because a coordinate was NaN or
/// infinite.
struct CloudFile {
  Cloud cloud;
  std::size_t dropped = 0;
};

/// Reads a PCD file (ascii, binary or binary_compressed; x y z and, where present, intensity, time
/// or t, ring, normals). Throws Error, with the path and what is wrong: cannot be opened, no x y z,
/// header that promises more than the file holds (checked against the file's size before anything
/// is allocated), cut short.
CloudFile read_pcd(const std::filesystem::path& file);

/// Reads a PLY file (ascii, binary little endian; element vertex with x y z; other elements are
/// skipped). Errors as read_pcd.
CloudFile read_ply(const std::filesystem::path& file);

/// Reads by the name's extension, .pcd or .ply. Throws Error for any other.
CloudFile read_cloud(const std::filesystem::path& file);

/// A binary PCD file of `cloud` with all arrays that it has.
std::string pcd_bytes(const Cloud& cloud);

/// A binary little-endian PLY file of `cloud` with all arrays that it has. `comment` becomes a
/// comment line if not empty.
std::string ply_bytes(const Cloud& cloud, const std::string& comment = "");

/// The beginning of such a file with nothing but x, y and z; 12 bytes a point follow, three
/// little-endian float32. For clouds too large to be held twice.
std::string pcd_header(std::size_t points);
std::string ply_header(std::size_t points, const std::string& comment = "");

}  // namespace plumb
