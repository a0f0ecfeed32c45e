#include "consistent.hpp"

#include <pcl/conversions.h>

#include <algorithm>
#include <pcl/recognition/impl/cg/geometric_consistency.hpp>

#include "shared/pcl/clouds.hpp"

namespace plumb::prune_geometric_consistency {
namespace {

/// Pair k joins point k of both clouds; PCL begins with those of the least `distance`.
::pcl::CorrespondencesPtr correspondences_of(const Matches& matches,
                                             const std::optional<Pose>& T_i_j) {
  ::pcl::CorrespondencesPtr result(new ::pcl::Correspondences);
  const Motion motion(T_i_j.value_or(Pose()));
  for (std::size_t k = 0; k < matches.size(); ++k) {
    const float distance =
        T_i_j ? (matches.p[k] - motion * matches.q[k]).norm() : static_cast<float>(k);
    const auto index = static_cast<::pcl::index_t>(k);
    result->emplace_back(index, index, distance);
  }
  return result;
}

}  // namespace

std::vector<std::uint32_t> largest_consistent(const Matches& matches,
                                              const std::optional<Pose>& T_i_j,
                                              const ConsistencyOptions& options) {
  if (matches.size() < options.gc_threshold) return {};
  ::pcl::GeometricConsistencyGrouping<::pcl::PointXYZ, ::pcl::PointXYZ> grouping;
  grouping.setInputCloud(pcl::points_of(matches.q));
  grouping.setSceneCloud(pcl::points_of(matches.p));
  grouping.setModelSceneCorrespondences(correspondences_of(matches, T_i_j));
  grouping.setGCSize(options.gc_size);
  grouping.setGCThreshold(static_cast<int>(options.gc_threshold) - 1);  // PCL: more than
  std::vector<::pcl::Correspondences> sets;
  grouping.cluster(sets);

  const auto largest = std::max_element(
      sets.begin(), sets.end(), [](const auto& a, const auto& b) { return a.size() < b.size(); });
  std::vector<std::uint32_t> kept;
  if (largest == sets.end()) return kept;
  for (const auto& pair : *largest) kept.push_back(static_cast<std::uint32_t>(pair.index_query));
  std::sort(kept.begin(), kept.end());
  return kept;
}

}  // namespace plumb::prune_geometric_consistency
