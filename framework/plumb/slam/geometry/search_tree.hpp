#pragma once
/// A kd-tree over points in space. Exact: every answer is what comparing with each point would
/// give, bit by bit.

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <vector>

namespace plumb {

/// Finds neighbours among points given as three arrays [m], which it copies. Points with a
/// non-finite coordinate are never found. Squared distances are ((dx*dx + dy*dy) +
/// dz*dz) in float; of equally near points the one with the lower index comes first, so results
/// depend on nothing but the points. All queries are const and safe to call from many threads.
class SearchTree {
 public:
  struct Neighbour {
    std::uint32_t index;     ///< of the point in the arrays given
    float squared_distance;  ///< [m^2]
    bool operator<(const Neighbour& other) const {
      return squared_distance < other.squared_distance ||
             (squared_distance == other.squared_distance && index < other.index);
    }
    bool operator==(const Neighbour&) const = default;
  };

  SearchTree(const float* x, const float* y, const float* z, std::size_t count);
  /// Of anything with arrays x, y, z, such as a Cloud.
  template <class Points>
  explicit SearchTree(const Points& points)
      : SearchTree(points.x.data(), points.y.data(), points.z.data(), points.x.size()) {}
  SearchTree(SearchTree&&) noexcept;
  SearchTree& operator=(SearchTree&&) noexcept;
  ~SearchTree();

  /// The `k` nearest points to `query`, nearest first, written to `out` (room for k). Returns how
  /// many there are: less than k only if the tree holds less. A query that is itself in the tree is
  /// found too.
  std::size_t nearest(const Eigen::Vector3f& query, std::size_t k, Neighbour* out) const;

  /// All points with squared distance <= radius * radius, into `out` (cleared first): nearest first
  /// if `sorted`, else in an order that depends on the points alone.
  void within(const Eigen::Vector3f& query, float radius, std::vector<Neighbour>& out,
              bool sorted) const;

  /// The nearest point, if its squared distance is <= max_distance * max_distance; false and `out`
  /// untouched if there is none.
  bool nearest_within(const Eigen::Vector3f& query, float max_distance, Neighbour& out) const;

  /// Number of points that can be found.
  std::size_t size() const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace plumb
