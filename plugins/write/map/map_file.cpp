#include "map_file.hpp"

#include <cmath>

#include "plumb/slam/io/cloud_file.hpp"

namespace plumb::write_map {

Eigen::Vector3d map_origin(const Trajectory& trajectory) {
  bool near = true;
  for (const auto& pose : trajectory.T_world_frame)
    near = near && pose.translation.cwiseAbs().maxCoeff() <= 10000;
  if (near) return Eigen::Vector3d::Zero();
  return trajectory.T_world_frame.front().translation.unaryExpr(
      [](double v) { return 1000 * std::round(v / 1000); });
}

std::string map_header(std::size_t points, const Eigen::Vector3d& origin, MapFormat format) {
  std::string comment;
  if (!origin.isZero()) {
    comment = "origin";
    for (const double v : origin) comment += " " + std::to_string(static_cast<long long>(v));
    comment += ": add to coordinates for world coordinates [m]";
  }
  if (format == MapFormat::ply) return ply_header(points, comment);
  std::string header = pcd_header(points);
  // A PCD may have comments anywhere in its header; before the first entry is where people look.
  if (!comment.empty()) header.insert(header.find("VERSION"), "# " + comment + "\n");
  return header;
}

}  // namespace plumb::write_map
