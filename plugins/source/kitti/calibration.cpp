#include "calibration.hpp"

#include <cmath>

#include "plumb/data/io/file_text.hpp"

namespace plumb::source_kitti {

Pose read_calibration(const std::filesystem::path& file) {
  const io::FileBytes bytes(file);
  io::Lines lines(bytes.view());
  for (std::string_view line; lines.next(line);) {
    const std::string_view name = io::next_word(line);
    if (name != "Tr:" && name != "Tr_velo_to_cam:") continue;
    Eigen::Matrix<double, 3, 4, Eigen::RowMajor> m;
    for (int k = 0; k < 12; ++k)
      if (!io::to_number(io::next_word(line), m.data()[k]) || !std::isfinite(m.data()[k]))
        io::refuse(file, lines.number(),
                   "expected 12 numbers after " + std::string(name) + ", a 3x4 matrix row by row");
    if (!io::next_word(line).empty())
      io::refuse(
          file, lines.number(),
          "has more than 12 numbers after " + std::string(name) + ", which are not a 3x4 matrix");
    const Eigen::Matrix3d r = m.leftCols<3>();
    if ((r.transpose() * r - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() > 1e-2 ||
        r.determinant() < 0)
      io::refuse(file, lines.number(),
                 "the 3x3 part after " + std::string(name) +
                     " is not a rotation: correct the calibration");
    return {r, m.col(3)};
  }
  io::refuse(file,
             "has no line 'Tr:', the laser in the camera's frame: give the sequence's calib.txt");
}

void camera_to_laser(Trajectory& trajectory, const Pose& T_camera_laser) {
  const Pose T_laser_camera = T_camera_laser.inverse();
  for (Pose& pose : trajectory.T_world_frame) pose = T_laser_camera * pose * T_camera_laser;
}

}  // namespace plumb::source_kitti
