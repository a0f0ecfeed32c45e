/// Clouds as binary PCD and PLY files.

#include <cstring>
#include <utility>
#include <vector>

#include "plumb/slam/io/cloud_file.hpp"

namespace plumb {
namespace {

struct Names {
  const char *nx, *ny, *nz;
};

/// The arrays of `cloud` in the order of a record. Ring comes last: all before it is float32.
struct Arrays {
  std::vector<std::pair<std::string, const std::vector<float>*>> floats;
  const std::vector<std::uint16_t>* ring = nullptr;

  Arrays(const Cloud& cloud, const Names& names)
      : floats{{"x", &cloud.x}, {"y", &cloud.y}, {"z", &cloud.z}} {
    const auto add = [&](const char* name, const std::vector<float>& values) {
      if (!cloud.empty() && values.size() == cloud.size()) floats.emplace_back(name, &values);
    };
    add("intensity", cloud.intensity);
    add("time", cloud.time);
    add(names.nx, cloud.nx);
    add(names.ny, cloud.ny);
    add(names.nz, cloud.nz);
    if (!cloud.empty() && cloud.ring.size() == cloud.size()) ring = &cloud.ring;
  }
};

/// `header` followed by one record a point.
std::string with_records(std::string header, const Arrays& arrays, std::size_t points) {
  const std::size_t step = 4 * arrays.floats.size() + (arrays.ring ? 2 : 0);
  const std::size_t begin = header.size();
  header.resize(begin + step * points);
  std::size_t offset = begin;
  for (const auto& [name, values] : arrays.floats) {
    for (std::size_t k = 0; k < points; ++k)
      std::memcpy(header.data() + offset + step * k, values->data() + k, 4);
    offset += 4;
  }
  if (arrays.ring)
    for (std::size_t k = 0; k < points; ++k)
      std::memcpy(header.data() + offset + step * k, arrays.ring->data() + k, 2);
  return header;
}

std::string pcd_header(const Arrays& arrays, std::size_t points) {
  std::string fields = "FIELDS", sizes = "\nSIZE", types = "\nTYPE", counts = "\nCOUNT";
  for (const auto& [name, values] : arrays.floats) {
    fields += " " + name;
    sizes += " 4";
    types += " F";
    counts += " 1";
  }
  if (arrays.ring) {
    fields += " ring";
    sizes += " 2";
    types += " U";
    counts += " 1";
  }
  const std::string number = std::to_string(points);
  return "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\n" + fields + sizes + types +
         counts + "\nWIDTH " + number + "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + number +
         "\nDATA binary\n";
}

std::string ply_header(const Arrays& arrays, std::size_t points, const std::string& comment) {
  std::string header = "ply\nformat binary_little_endian 1.0\n";
  if (!comment.empty()) {
    std::string line = comment;
    for (char& c : line)
      if (c == '\n' || c == '\r') c = ' ';
    header += "comment " + line + "\n";
  }
  header += "element vertex " + std::to_string(points) + "\n";
  for (const auto& [name, values] : arrays.floats) header += "property float " + name + "\n";
  if (arrays.ring) header += "property ushort ring\n";
  return header + "end_header\n";
}

constexpr Names pcd_names{"normal_x", "normal_y", "normal_z"}, ply_names{"nx", "ny", "nz"};

}  // namespace

std::string pcd_bytes(const Cloud& cloud) {
  const Arrays arrays(cloud, pcd_names);
  return with_records(pcd_header(arrays, cloud.size()), arrays, cloud.size());
}

std::string ply_bytes(const Cloud& cloud, const std::string& comment) {
  const Arrays arrays(cloud, ply_names);
  return with_records(ply_header(arrays, cloud.size(), comment), arrays, cloud.size());
}

std::string pcd_header(std::size_t points) {
  return pcd_header(Arrays(Cloud(), pcd_names), points);
}

std::string ply_header(std::size_t points, const std::string& comment) {
  return ply_header(Arrays(Cloud(), ply_names), points, comment);
}

}  // namespace plumb
