#include "shot.hpp"

#include <pcl/features/boundary.h>
#include <pcl/features/shot.h>

#include <algorithm>
#include <cmath>

#include "shared/pcl/clouds.hpp"

namespace plumb::describe_shot {
namespace {

using Signature = ::pcl::SHOT352;
using Signatures = ::pcl::PointCloud<Signature>;
using Borders = ::pcl::PointCloud<::pcl::Boundary>;

/// The keypoints that have a normal: their places among the points that have one.
::pcl::IndicesPtr places_of(const std::vector<std::uint32_t>& keys, const pcl::Oriented& surface) {
  ::pcl::IndicesPtr places(new ::pcl::Indices);
  for (const auto key : keys) {
    const auto at = std::lower_bound(surface.index.begin(), surface.index.end(), key);
    if (at != surface.index.end() && *at == key)
      places->push_back(static_cast<::pcl::index_t>(at - surface.index.begin()));
  }
  return places;
}

Signatures signatures_at(const ::pcl::IndicesPtr& places, const pcl::Oriented& surface,
                         const ShotOptions& options) {
  ::pcl::SHOTEstimation<::pcl::PointXYZ, ::pcl::Normal, Signature> estimate;
  estimate.setInputCloud(surface.points);
  estimate.setIndices(places);
  estimate.setInputNormals(surface.normals);
  estimate.setRadiusSearch(options.radius);
  estimate.setLRFRadius(static_cast<float>(options.lrf_radius.value_or(options.radius)));
  Signatures signatures;
  estimate.compute(signatures);
  return signatures;
}

Borders borders_at(const ::pcl::IndicesPtr& places, const pcl::Oriented& surface,
                   const ShotOptions& options) {
  ::pcl::BoundaryEstimation<::pcl::PointXYZ, ::pcl::Normal, ::pcl::Boundary> estimate;
  estimate.setInputCloud(surface.points);
  estimate.setIndices(places);
  estimate.setInputNormals(surface.normals);
  estimate.setRadiusSearch(options.radius);
  estimate.setAngleThreshold(static_cast<float>(options.border_angle));
  Borders borders;
  estimate.compute(borders);
  return borders;
}

bool is_described(const Signature& signature) {
  return std::all_of(std::begin(signature.descriptor), std::end(signature.descriptor),
                     [](float value) { return std::isfinite(value); });
}

}  // namespace

Shot shot(const Cloud& cloud, const std::vector<std::uint32_t>& keys, const ShotOptions& options) {
  Shot result;
  Features& features = result.features;
  features.dimension = shot_size;
  const pcl::Oriented surface = pcl::oriented(cloud);
  const ::pcl::IndicesPtr places = places_of(keys, surface);
  result.left_out = keys.size() - places->size();
  if (places->empty()) return result;
  const Signatures signatures = signatures_at(places, surface, options);
  const Borders borders = borders_at(places, surface, options);
  for (std::size_t k = 0; k < places->size(); ++k) {
    if (!is_described(signatures[k])) {
      ++result.left_out;
      continue;
    }
    const std::uint32_t at = surface.index[static_cast<std::size_t>((*places)[k])];
    result.index.push_back(at);
    features.points.push_back(cloud.point(at));
    features.normals.push_back(cloud.normal(at));
    features.at_border.push_back(borders[k].boundary_point ? 1 : 0);
    features.vectors.insert(features.vectors.end(), std::begin(signatures[k].descriptor),
                            std::end(signatures[k].descriptor));
  }
  return result;
}

}  // namespace plumb::describe_shot
