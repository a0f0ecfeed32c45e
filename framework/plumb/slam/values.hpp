#pragma once
/// The remaining values that travel on wires.

#include <string>
#include <vector>

#include "plumb/data/number.hpp"
#include "plumb/slam/graph.hpp"
#include "plumb/slam/segment.hpp"
#include "plumb/slam/trajectory.hpp"

namespace plumb {

/// One vector that describes a whole segment (ESF: 640).
struct Descriptor {
  std::vector<float> values;
};

/// Keypoints of a segment [m, segment coordinates] with one vector each.
struct Features {
  std::uint32_t dimension = 0;  ///< length of each vector (FPFH: 33)
  std::vector<Eigen::Vector3f> points;
  std::vector<Eigen::Vector3f> normals;  ///< one a point, or empty
  std::vector<float> vectors;            ///< point-major: vectors[k * dimension + d]
  std::vector<std::uint8_t> at_border;   ///< 1 where the point lies at the cloud's border

  std::size_t size() const { return points.size(); }
  const float* vector(std::size_t k) const { return vectors.data() + k * dimension; }
};

/// 2-D occupancy: cell (column, row) covers origin + resolution * [column, column+1) x [row,
/// row+1).
struct GridMap {
  double resolution = 0;  ///< [m]
  Eigen::Vector2d origin =
      Eigen::Vector2d::Zero();  ///< world coordinates of the first cell's corner [m]
  std::uint32_t columns = 0, rows = 0;
  std::vector<float> log_odds;  ///< row-major; 0 is unknown
};

/// What became of one edge in one stage.
struct EdgeRecord {
  std::uint32_t i = 0, j = 0;
  EdgeKind kind = EdgeKind::sequential;
  std::uint32_t found = 0, kept = 0;  ///< point pairs before and after pruning
  double residual = 0;                ///< rms distance of the kept pairs after solving [m]
  double weight = 1;                  ///< mean robust weight, 0 to 1
  std::string status;                 ///< "accepted", "down-weighted", "rejected" or "no matches"
};

/// Named numbers, the first being the one that the value is known by, and records per edge.
struct Metrics {
  std::vector<Number> numbers;
  std::vector<EdgeRecord> edges;
  std::vector<std::string> notes;  ///< sentences for the reader: what is weak

  /// Adds a number and returns the metrics, for building them in one expression.
  Metrics& add(std::string name, double value, std::string unit) {
    numbers.push_back({std::move(name), value, std::move(unit)});
    return *this;
  }
};

template <class Archive, class T>
requires std::is_same_v<std::remove_const_t<T>, Descriptor>
void fields(Archive& a, T& d) { a(d.values); }
template <class Archive, class T>
requires std::is_same_v<std::remove_const_t<T>, Features>
void fields(Archive& a, T& f) { a(f.dimension, f.points, f.normals, f.vectors, f.at_border); }
template <class Archive, class T>
requires std::is_same_v<std::remove_const_t<T>, GridMap>
void fields(Archive& a, T& g) { a(g.resolution, g.origin, g.columns, g.rows, g.log_odds); }
template <class Archive, class T>
requires std::is_same_v<std::remove_const_t<T>, EdgeRecord>
void fields(Archive& a, T& e) {
  a(e.i, e.j, e.kind, e.found, e.kept, e.residual, e.weight, e.status);
}
template <class Archive, class T>
requires std::is_same_v<std::remove_const_t<T>, Metrics>
void fields(Archive& a, T& m) { a(m.numbers, m.edges, m.notes); }

}  // namespace plumb
