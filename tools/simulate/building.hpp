#pragma once
/// Buildings to drive a scanner through.

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "simulate/floor_plan.hpp"

namespace plumb::simulate {

struct Building {
  std::vector<Wall> walls;
  std::vector<Eigen::Vector2d> way;  ///< corners of the drive, from the origin and first along x
};

struct BuildingOptions {
  std::string name;    ///< one of indoor_names()
  double length = 0;   ///< of the long corridors or of a row of rooms [m]
  double spacing = 0;  ///< of corridors that look alike [m]
  double overlap = 0;  ///< driven again after the round [m]
  std::uint64_t seed = 1;
};

/// Throws Error for a name that is none of indoor_names().
Building build(const BuildingOptions& options);

}  // namespace plumb::simulate
