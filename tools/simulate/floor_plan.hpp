#pragma once
/// A building as its floor: what may be walked on, and the walls round it.

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace plumb::simulate {

/// A straight piece of wall from a to b [m].
struct Wall {
  Eigen::Vector2d a, b;
  bool operator==(const Wall&) const = default;
};

/// Edges along x and y [m], x0 < x1, y0 < y1.
struct Rectangle {
  double x0, y0, x1, y1;
};

/// Floors and what stands on them; walls() is the border between.
class FloorPlan {
 public:
  /// Floor: corridors, rooms, and the openings between them, which overlap or touch.
  void open(const Rectangle& floor) { floors_.push_back(floor); }
  /// Wall or pillar where floor was.
  void fill(const Rectangle& solid) { solids_.push_back(solid); }
  /// A box of size [m] about `centre`, turned by `heading` [rad].
  void box(const Eigen::Vector2d& centre, const Eigen::Vector2d& size, double heading);
  /// A round column as a polygon of 12 sides.
  void column(const Eigen::Vector2d& centre, double radius);
  /// A thin thing such as the leaf of a door.
  void leaf(const Wall& wall) { loose_.push_back(wall); }

  /// All walls: those along x and y as long as they go straight on, then the rest.
  std::vector<Wall> walls() const;
  /// Whether a point is on floor and in no solid rectangle (boxes, columns and leaves not asked).
  bool is_floor(const Eigen::Vector2d& point) const;

 private:
  std::vector<Rectangle> floors_, solids_;
  std::vector<Wall> loose_;
};

/// Distance from the point to the nearest wall [m].
double clearance(const std::vector<Wall>& walls, const Eigen::Vector2d& point);

}  // namespace plumb::simulate
