#include "simulate/building.hpp"

#include <algorithm>

#include "plumb/data/error.hpp"
#include "simulate/corridor_wall.hpp"
#include "simulate/indoor_scene.hpp"
#include "simulate/names.hpp"

namespace plumb::simulate {
namespace {

using Eigen::Vector2d;
using Kind = Feature::Kind;

constexpr double behind = 4;  // the first corridor begins so far behind the start [m]

void open_strip(FloorPlan& plan, const Strip& strip, double from, double to) {
  plan.open(strip.rectangle(from, -half_width, to, half_width));
}

/// Rooms and cabinets along both walls of a corridor.
void add_rooms(FloorPlan& plan, const Strip& strip, double length, Random& random) {
  for (const double side : {1.0, -1.0})
    for (double s = 1.5; s + 3 < length - 1.5;) {
      const double end = std::min(millimetres(s + random.uniform(3.5, 6)), length - 1.5);
      if (random.chance(0.7))
        add_room(plan, strip, s, end, side, random);
      else
        add(plan, strip, {random.chance(0.5) ? Kind::cabinet : Kind::niche, s + 1.2, side});
      s = end + 0.2;
    }
}

Building corridor(const BuildingOptions& options) {
  const double length = options.length, height = std::max(12.0, millimetres(0.5 * length));
  const double west = -behind, east = length - behind;
  Random random(mix(options.seed, 10));
  FloorPlan plan;
  const Strip south{{west, 0}, 0}, up{{east, 0}, 1}, north{{east, height}, 2},
      down{{west, height}, 3};
  for (const Strip& strip : {south, north})
    open_strip(plan, strip, -half_width, length + half_width);
  for (const Strip& strip : {up, down}) open_strip(plan, strip, -half_width, height + half_width);
  for (const Feature& feature : sparse_features(random, 2, length - 2)) {
    add(plan, south, feature);
    add(plan, north, feature);
  }
  if (length >= 24)  // the one thing that tells the long corridors apart, on the inner side
    add_room(plan, north, 0.5 * length - 2, 0.5 * length + 2, 1, random);
  add_rooms(plan, up, height, random);
  add_rooms(plan, down, height, random);
  return {plan.walls(),
          {{0, 0}, {east, 0}, {east, height}, {west, height}, {west, 0}, {options.overlap, 0}}};
}

Building lookalike(const BuildingOptions& options) {
  constexpr int corridors = 4;
  const double length = options.length, spacing = options.spacing;
  const double west = -behind, east = length - behind, top = (corridors - 1) * spacing;
  Random random(mix(options.seed, 11));
  FloorPlan plan;
  const std::vector<Feature> features = sparse_features(random, 2, length - 2);
  for (int k = 0; k < corridors; ++k) {
    const Strip strip = k % 2 == 0 ? Strip{{west, k * spacing}, 0} : Strip{{east, k * spacing}, 2};
    open_strip(plan, strip, 0, length);
    for (const Feature& feature : features) add(plan, strip, feature);
  }
  // The passages go on beyond the outermost corridors, so that all their mouths look alike; what
  // stands on the outer walls between the mouths is each passage's own.
  const Strip up{{east, -spacing}, 1}, down{{west, top + spacing}, 3};
  for (const Strip& strip : {up, down}) {
    open_strip(plan, strip, 0, top + 2 * spacing);
    for (int k = 0; k <= corridors; ++k)
      if (random.chance(0.7))
        add(plan, strip, {random.chance(0.5) ? Kind::door : Kind::pillar, (k + 0.5) * spacing, -1});
  }
  std::vector<Vector2d> way{{0, 0}};
  for (int k = 0; k < corridors; ++k) {
    way.emplace_back(k % 2 == 0 ? east : west, k * spacing);
    if (k + 1 < corridors) way.emplace_back(way.back().x(), (k + 1) * spacing);
  }
  way.emplace_back(west, 0);
  way.emplace_back(options.overlap, 0);
  return {plan.walls(), way};
}

Building rooms(const BuildingOptions& options) {
  constexpr double depth = 5.2, wall = 0.2, door = 1;
  const double width = millimetres(options.length / 3);
  Random random(mix(options.seed, 12));
  FloorPlan plan;
  const auto centre = [&](int column, int row) -> Vector2d {
    return {column * width, row * depth};
  };
  const Vector2d half(0.5 * (width - wall), 0.5 * (depth - wall));
  for (int column = 0; column < 3; ++column)
    for (int row = 0; row < 2; ++row) {
      const Vector2d c = centre(column, row), low = c - half, high = c + half;
      plan.open({low.x(), low.y(), high.x(), high.y()});
      for (const double x : {-1.0, 1.0})
        for (const double y : {-1.0, 1.0})
          if (random.chance(0.7))
            add_furniture(plan, c + Vector2d(x * (half.x() - 0.8), y * (half.y() - 0.8)), random);
    }
  const std::vector<Vector2d> ring = {centre(0, 0), centre(1, 0), centre(2, 0),
                                      centre(2, 1), centre(1, 1), centre(0, 1)};
  for (std::size_t k = 0; k < ring.size(); ++k) {
    const Vector2d middle = 0.5 * (ring[k] + ring[(k + 1) % ring.size()]);
    const double reach = 0.5 * door;  // square: through the wall and along it
    plan.open({middle.x() - reach, middle.y() - reach, middle.x() + reach, middle.y() + reach});
  }
  return {plan.walls(), {ring[0], ring[2], ring[3], ring[5], ring[0], {options.overlap, 0}}};
}

}  // namespace

Building build(const BuildingOptions& options) {
  if (options.name == "corridor") return corridor(options);
  if (options.name == "lookalike") return lookalike(options);
  if (options.name == "rooms") return rooms(options);
  throw Error("no building is called '" + options.name + "'; " +
              suggestion(options.name, indoor_names()));
}

}  // namespace plumb::simulate
