#pragma once
/// What the walls of a corridor carry, laid out along it.

#include <cmath>
#include <vector>

#include "simulate/floor_plan.hpp"
#include "simulate/random.hpp"

namespace plumb::simulate {

constexpr double half_width = 1;  ///< of a corridor [m]

/// To the millimetre, so that a plan in text is exact.
inline double millimetres(double v) { return std::round(1000 * v) / 1000; }

/// A corridor along x or y: `s` runs along its axis from `start`, `d` to the left of it [m].
struct Strip {
  Eigen::Vector2d start;
  int quarter;  ///< turns by 90 degrees from x

  Eigen::Vector2d at(double s, double d) const {
    constexpr double cosine[] = {1, 0, -1, 0}, sine[] = {0, 1, 0, -1};
    const double c = cosine[quarter], n = sine[quarter];
    return start + Eigen::Vector2d(c * s - n * d, n * s + c * d);
  }
  Rectangle rectangle(double s0, double d0, double s1, double d1) const {
    const Eigen::Vector2d a = at(s0, d0), b = at(s1, d1);
    const Eigen::Vector2d low = a.cwiseMin(b), high = a.cwiseMax(b);
    return {low.x(), low.y(), high.x(), high.y()};
  }
};

/// One thing on a wall.
struct Feature {
  enum class Kind { door, pillar, niche, cabinet } kind;
  double s;     ///< its middle [m]
  double side;  ///< 1 left, -1 right
};

/// Closed doors in their frames and pillars, now and then a niche, every 2.5 to 6 m on both walls.
std::vector<Feature> sparse_features(Random& random, double from, double to);

void add(FloorPlan& plan, const Strip& strip, const Feature& feature);

/// A room from s0 to s1 behind the wall, with a door that stands open and furniture.
void add_room(FloorPlan& plan, const Strip& strip, double s0, double s1, double side,
              Random& random);

/// A box or a round column about `centre`.
void add_furniture(FloorPlan& plan, const Eigen::Vector2d& centre, Random& random);

}  // namespace plumb::simulate
