#pragma once
/// A spinning multi-line laser scanner.

#include <cstdint>
#include <numbers>
#include <vector>

#include "plumb/slam/cloud.hpp"
#include "plumb/slam/geometry/pose.hpp"
#include "simulate/world.hpp"

namespace plumb::simulate {

/// The defaults are those of an Ouster OS1-64.
struct ScannerOptions {
  int lines = 64;
  int columns = 1024;
  double lowest = -16.6 * (std::numbers::pi / 180);  ///< elevation of the lowest line [rad]
  double highest = 16.6 * (std::numbers::pi / 180);  ///< of the highest [rad]
  double noise = 0.02;  ///< deviation of the range [m], nearly normal, never beyond 3.47 deviations
  double range = 120;   ///< greatest range [m]
};

class Scanner {
 public:
  Scanner(const ScannerOptions& options, std::uint64_t seed);

  /// One turn, in the sensor's coordinates (x ahead, z up) with intensity (0 to 255: reflectance
  /// times the cosine of incidence), column by column. Every ray starts at the one pose, as in a
  /// frame whose motion is compensated. What is out of range gives no point, nor what throws too
  /// little light back: at `range` a surface of reflectance 0.1 met at a right angle is just seen,
  /// nearer by the square of the distance more. `frame` picks the noise.
  Cloud scan(const World& world, const Pose& T_world_sensor, std::uint64_t frame) const;

 private:
  ScannerOptions options_;
  std::uint64_t seed_;
  std::vector<Eigen::Vector3f> directions_;  ///< in the sensor's coordinates
};

}  // namespace plumb::simulate
