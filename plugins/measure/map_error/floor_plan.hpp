#pragma once
/// A floor plan: true walls as segments, and how far a place is from the nearest.

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace plumb::measure_map_error {

/// A straight piece of wall [m].
struct Wall {
  Eigen::Vector2d a, b;
};

/// Reads lines `x1 y1 x2 y2`; blank lines and comments (#) are skipped. Throws Error with
/// file:line: another number of words, a word that is no number, no wall at all.
std::vector<Wall> read_plan(const std::filesystem::path& file);

/// Distance [m] from `p` to the nearest point of `wall`.
double distance(const Wall& wall, const Eigen::Vector2d& p);

/// A tree of boxes over walls: the distance to the nearest wall without looking at all of them.
class WallTree {
 public:
  explicit WallTree(std::vector<Wall> walls);  ///< at least one
  double distance_to(const Eigen::Vector2d& p) const;

 private:
  struct Node {
    Eigen::Array2d low, high;
    std::uint32_t first,
        count;  ///< walls of a leaf; count 0: the children are `first` and `first` + 1
  };
  void build(std::uint32_t node, std::uint32_t first, std::uint32_t count);
  void search(std::uint32_t node, const Eigen::Vector2d& p, double& best) const;
  double to_box(std::uint32_t node, const Eigen::Vector2d& p) const;

  std::vector<Wall> walls_;
  std::vector<Node> nodes_;
};

}  // namespace plumb::measure_map_error
