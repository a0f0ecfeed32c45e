#pragma once
/// PCL's way to compute what our kernels compute, as a judge in tests and benchmarks.
///
/// A library of its own, with no Eigen type in its face: PCL was packaged without AVX, and Eigen
/// with AVX allocates differently (EIGEN_DEFAULT_ALIGN_BYTES is 32 even where EIGEN_MAX_ALIGN_BYTES
/// is 16), so a matrix made on one side must not be freed on the other.

#include <cstdint>
#include <memory>
#include <vector>

namespace plumb::twins {

/// A cloud in PCL's form; normals may be empty.
class PclCloud {
 public:
  PclCloud(const std::vector<float>& x, const std::vector<float>& y, const std::vector<float>& z,
           const std::vector<float>& nx, const std::vector<float>& ny,
           const std::vector<float>& nz);
  ~PclCloud();

  /// FPFHEstimationOMP at the points `keys`, the whole cloud being the surface: 33 numbers a point.
  std::vector<float> fpfh(const std::vector<std::uint32_t>& keys, double radius,
                          unsigned threads) const;
  /// NormalEstimationOMP with the k nearest, turned to the origin: x, y, z of each point.
  std::vector<float> normals(unsigned k, unsigned threads) const;
  /// ESFEstimation: 640 numbers. Seeded by the clock, in whole seconds.
  std::vector<float> esf() const;
  /// StatisticalOutlierRemoval: the indices of the points that it keeps.
  std::vector<int> without_outliers(int mean_k, double stddev_mul_thresh) const;

 private:
  struct Held;
  std::unique_ptr<Held> held_;
};

}  // namespace plumb::twins
