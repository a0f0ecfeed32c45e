#include "simulate/corridor_wall.hpp"

#include <numbers>

namespace plumb::simulate {
namespace {

using Eigen::Vector2d;

constexpr double into = 0.1;  // a piece reaches into what it joins, so that no slit is left [m]
constexpr double thickness = 0.2;  // of the walls of rooms [m]
constexpr double room_depth = 4;   // [m]
constexpr double door = 0.9;       // [m]

/// Along the wall, and into it (positive) or out of it [m].
struct Shape {
  double width, depth;
};

Shape shape_of(Feature::Kind kind) {
  switch (kind) {
    case Feature::Kind::door:
      return {door, 0.08};
    case Feature::Kind::pillar:
      return {0.3, -0.15};
    case Feature::Kind::niche:
      return {1.4, 0.4};
    case Feature::Kind::cabinet:
      return {0.8, -0.35};
  }
  return {door, 0.08};
}

}  // namespace

std::vector<Feature> sparse_features(Random& random, double from, double to) {
  std::vector<Feature> features;
  for (const double side : {1.0, -1.0})
    for (double s = from + random.uniform(0, 3); s < to; s += random.uniform(2.5, 6)) {
      const double pick = random.uniform(0, 1);
      const auto kind = pick < 0.6   ? Feature::Kind::door
                        : pick < 0.9 ? Feature::Kind::pillar
                                     : Feature::Kind::niche;
      features.push_back({kind, millimetres(s), side});
    }
  return features;
}

void add(FloorPlan& plan, const Strip& strip, const Feature& feature) {
  const auto [width, depth] = shape_of(feature.kind);
  const double s0 = feature.s - 0.5 * width, s1 = feature.s + 0.5 * width, side = feature.side;
  if (depth > 0)
    plan.open(strip.rectangle(s0, side * (half_width - into), s1, side * (half_width + depth)));
  else
    plan.fill(strip.rectangle(s0, side * (half_width + depth), s1, side * (half_width + into)));
}

void add_room(FloorPlan& plan, const Strip& strip, double s0, double s1, double side,
              Random& random) {
  const double near = half_width + thickness, far = near + room_depth;
  plan.open(strip.rectangle(s0, side * near, s1, side * far));
  const double hinge = millimetres(random.uniform(s0 + 0.4, s1 - 0.4 - door));
  plan.open(strip.rectangle(hinge, side * (half_width - into), hinge + door, side * (near + into)));
  const double ajar = random.uniform(0.3, 0.5) * std::numbers::pi;
  plan.leaf({strip.at(hinge, side * near),
             strip.at(hinge + door * std::cos(ajar), side * (near + door * std::sin(ajar)))});
  for (const double s : {s0 + 0.8, s1 - 0.8})
    add_furniture(plan, strip.at(s, side * (far - random.uniform(0.7, 1.6))), random);
}

void add_furniture(FloorPlan& plan, const Vector2d& centre, Random& random) {
  if (random.chance(0.25)) {
    plan.column(centre, random.uniform(0.15, 0.35));
    return;
  }
  const Vector2d size(random.uniform(0.4, 0.9), random.uniform(0.3, 0.7));
  plan.box(centre, size, random.chance(0.5) ? 0 : random.uniform(0, std::numbers::pi));
}

}  // namespace plumb::simulate
