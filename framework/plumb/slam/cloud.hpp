#pragma once
/// A point cloud as a structure of arrays, independent of PCL, so that modules agree on its layout.

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "plumb/slam/eigen_archive.hpp"
#include "plumb/slam/geometry/box.hpp"

namespace plumb {

/// Points in local coordinates [m]. x, y, z have one entry a point; every other array has that or
/// is empty.
struct Cloud {
  std::vector<float> x, y, z;
  std::vector<float> intensity;     ///< as the sensor gave it
  std::vector<float> time;          ///< [s] after the frame's stamp
  std::vector<std::uint16_t> ring;  ///< scan line
  std::vector<float> nx, ny, nz;    ///< unit normals

  std::size_t size() const { return x.size(); }
  bool empty() const { return x.empty(); }
  bool has_normals() const { return !x.empty() && nx.size() == x.size(); }
  Eigen::Vector3f point(std::size_t k) const { return {x[k], y[k], z[k]}; }
  Eigen::Vector3f normal(std::size_t k) const { return {nx[k], ny[k], nz[k]}; }
  void add(const Eigen::Vector3f& p) {
    x.push_back(p.x());
    y.push_back(p.y());
    z.push_back(p.z());
  }
  void reserve(std::size_t n) {
    x.reserve(n);
    y.reserve(n);
    z.reserve(n);
  }
  std::size_t bytes() const {
    return sizeof(float) * (x.size() + y.size() + z.size() + intensity.size() + time.size() +
                            nx.size() + ny.size() + nz.size()) +
           sizeof(std::uint16_t) * ring.size();
  }
};

/// The points of `cloud` with the given indices, in that order, with every array that it has.
Cloud select(const Cloud& cloud, const std::vector<std::uint32_t>& indices);

/// The smallest box round all points.
Box box_of(const Cloud& cloud);

/// Mean of all points [m], summed in double; zero for an empty cloud.
Eigen::Vector3f centroid_of(const Cloud& cloud);

/// Visits the arrays: what hashes, stores and reads a cloud sees exactly this list.
template <class Archive, class C>
requires std::is_same_v<std::remove_const_t<C>, Cloud>
void fields(Archive& a, C& c) { a(c.x, c.y, c.z, c.intensity, c.time, c.ring, c.nx, c.ny, c.nz); }

}  // namespace plumb
