#include "pcl_steps.hpp"

#include "../../plugins/describe/gasd/gasd.hpp"
#include "../../plugins/describe/shot/shot.hpp"
#include "../../plugins/describe/vfh/vfh.hpp"
#include "../../plugins/filter/covariance_sampling/covariance_sampling.hpp"
#include "../../plugins/filter/normal_space/normal_space.hpp"
#include "../../plugins/filter/radius_outlier/radius_outlier.hpp"
#include "../../plugins/keypoints/harris3d/harris3d.hpp"
#include "../../plugins/keypoints/iss/iss.hpp"
#include "../../plugins/prune/geometric_consistency/consistent.hpp"
#include "../../plugins/prune/hough/hough.hpp"
#include "../../plugins/prune/one_to_one/one_to_one.hpp"
#include "../../plugins/register/gicp/gicp.hpp"
#include "../../plugins/register/ndt/ndt.hpp"

namespace plumb::twins {

std::size_t iss(const Cloud& cloud) { return keypoints_iss::iss(cloud, {}).size(); }

std::size_t harris3d(const Cloud& cloud) { return keypoints_harris3d::harris3d(cloud, {}).size(); }

std::size_t shot(const Cloud& cloud, const std::vector<std::uint32_t>& keys) {
  return describe_shot::shot(cloud, keys, {}).features.vectors.size();
}

std::size_t vfh(const Cloud& cloud) {
  const auto vector = describe_vfh::vfh(cloud, {});
  return vector ? vector->size() : 0;
}

std::size_t gasd(const Cloud& cloud) {
  const auto vector = describe_gasd::gasd(cloud, describe_gasd::Interpolation::quadrilinear);
  return vector ? vector->size() : 0;
}

std::size_t radius_outlier(const Cloud& cloud, double radius, std::uint32_t min_neighbours) {
  return filter_radius_outlier::not_alone(cloud, radius, min_neighbours).size();
}

std::size_t covariance_sampling(const Cloud& cloud, std::size_t count) {
  return filter_covariance_sampling::stable_points(cloud, count).size();
}

std::size_t normal_space(const Cloud& cloud, std::size_t count) {
  constexpr std::uint32_t bins = 8, seed = 1;
  return filter_normal_space::alike_in_normals(cloud, count, bins, seed).size();
}

std::vector<std::uint32_t> geometric_consistency(const Matches& matches) {
  return prune_geometric_consistency::largest_consistent(matches, Pose(), {});
}

std::vector<std::uint32_t> hough(const Matches& matches) {
  return prune_hough::most_voted(matches, prune_hough::frames_of_pose(matches.size(), Pose()), {});
}

std::vector<std::uint32_t> one_to_one(const Matches& matches) {
  return prune_one_to_one::one_to_one(matches, Pose());
}

std::uint32_t gicp(const Cloud& i, const Cloud& j, const Pose& T_i_j) {
  constexpr double max_correspondence_distance = 1;
  return register_gicp::gicp(i, j, T_i_j, max_correspondence_distance, {}).iterations;
}

std::uint32_t ndt(const Cloud& i, const Cloud& j, const Pose& T_i_j) {
  return register_ndt::ndt(i, j, T_i_j, {}).iterations;
}

}  // namespace plumb::twins
