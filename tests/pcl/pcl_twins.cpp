#include "pcl_twins.hpp"

#include <pcl/features/esf.h>
#include <pcl/features/fpfh_omp.h>
#include <pcl/features/normal_3d_omp.h>
#include <pcl/filters/statistical_outlier_removal.h>
#include <pcl/point_types.h>
#include <pcl/search/kdtree.h>

namespace plumb::twins {

struct PclCloud::Held {
  pcl::PointCloud<pcl::PointXYZ>::Ptr points{new pcl::PointCloud<pcl::PointXYZ>};
  pcl::PointCloud<pcl::Normal>::Ptr normals{new pcl::PointCloud<pcl::Normal>};
};

PclCloud::PclCloud(const std::vector<float>& x, const std::vector<float>& y,
                   const std::vector<float>& z, const std::vector<float>& nx,
                   const std::vector<float>& ny, const std::vector<float>& nz)
    : held_(new Held) {
  for (std::size_t k = 0; k < x.size(); ++k) held_->points->emplace_back(x[k], y[k], z[k]);
  for (std::size_t k = 0; k < nx.size(); ++k) held_->normals->emplace_back(nx[k], ny[k], nz[k]);
}

PclCloud::~PclCloud() = default;

std::vector<float> PclCloud::fpfh(const std::vector<std::uint32_t>& keys, double radius,
                                  unsigned threads) const {
  pcl::PointCloud<pcl::PointXYZ>::Ptr at(new pcl::PointCloud<pcl::PointXYZ>);
  for (const auto k : keys) at->push_back((*held_->points)[k]);
  pcl::FPFHEstimationOMP<pcl::PointXYZ, pcl::Normal, pcl::FPFHSignature33> estimate(threads);
  estimate.setInputCloud(at);
  estimate.setSearchSurface(held_->points);
  estimate.setInputNormals(held_->normals);
  pcl::search::KdTree<pcl::PointXYZ>::Ptr tree(new pcl::search::KdTree<pcl::PointXYZ>);
  estimate.setSearchMethod(tree);
  estimate.setRadiusSearch(radius);
  pcl::PointCloud<pcl::FPFHSignature33> signatures;
  estimate.compute(signatures);
  std::vector<float> result;
  for (const auto& s : signatures) result.insert(result.end(), s.histogram, s.histogram + 33);
  return result;
}

std::vector<float> PclCloud::normals(unsigned k, unsigned threads) const {
  pcl::NormalEstimationOMP<pcl::PointXYZ, pcl::Normal> estimate(threads);
  estimate.setInputCloud(held_->points);
  pcl::search::KdTree<pcl::PointXYZ>::Ptr tree(new pcl::search::KdTree<pcl::PointXYZ>);
  estimate.setSearchMethod(tree);
  estimate.setKSearch(static_cast<int>(k));
  pcl::PointCloud<pcl::Normal> found;
  estimate.compute(found);
  std::vector<float> result;
  for (const auto& n : found) result.insert(result.end(), n.normal, n.normal + 3);
  return result;
}

std::vector<float> PclCloud::esf() const {
  pcl::ESFEstimation<pcl::PointXYZ, pcl::ESFSignature640> estimate;
  estimate.setInputCloud(held_->points);
  pcl::PointCloud<pcl::ESFSignature640> signature;
  estimate.compute(signature);
  return {signature[0].histogram, signature[0].histogram + 640};
}

std::vector<int> PclCloud::without_outliers(int mean_k, double stddev_mul_thresh) const {
  pcl::StatisticalOutlierRemoval<pcl::PointXYZ> remove;
  remove.setInputCloud(held_->points);
  remove.setMeanK(mean_k);
  remove.setStddevMulThresh(stddev_mul_thresh);
  std::vector<int> kept;
  remove.filter(kept);
  return kept;
}

}  // namespace plumb::twins
