#include "submap.hpp"

#include "shared/planar/line_normal.hpp"
#include "shared/thinning/spots.hpp"

namespace plumb::track_sliding_window {
namespace {

constexpr double search_resolution = 0.05;  // [m]
constexpr double search_sigma = 0.1;        // [m] how far off a point may lie and still count

planar::Prior prior_at(const PlanarPose& start, bool known) {
  return known ? planar::Prior{start, 0.1, 0.05, 0.05} : planar::Prior{start, 0.1, 0.3, 0.3};
}

}  // namespace

void Submap::add(const Cloud& scan, const PlanarPose& T_world_scan, bool with_normals) {
  scans_.push_back({&scan, T_world_scan});
  if (scans_.size() > options_.frames) scans_.pop_front();
  stitch();
  tree_.emplace(cloud_);
  field_.reset();
  if (with_normals) find_normals();
}

void Submap::stitch() {
  std::optional<thinning::Spots> spots;
  if (options_.voxel_size) spots.emplace(*options_.voxel_size);
  cloud_ = {};
  const PlanarPose T_newest_world = newest().inverse();
  for (const Member& member : scans_) {
    const PlanarPose T = T_newest_world * member.T_world_scan;
    const auto c = static_cast<float>(std::cos(T.yaw)), s = static_cast<float>(std::sin(T.yaw));
    const auto x = static_cast<float>(T.x), y = static_cast<float>(T.y);
    for (std::size_t k = 0; k < member.scan->size(); ++k) {
      const float px = member.scan->x[k], py = member.scan->y[k];
      const Eigen::Vector3f point(x + c * px - s * py, y + s * px + c * py, 0);
      if (spots)
        spots->add(point.x(), point.y(), 0);
      else
        cloud_.add(point);
    }
  }
  if (spots) cloud_ = spots->means<Cloud>();
}

void Submap::find_normals() {
  const std::size_t size = cloud_.size();
  cloud_.nx.resize(size), cloud_.ny.resize(size);
  std::vector<SearchTree::Neighbour> found;
  std::vector<Eigen::Vector3f> round;
  for (std::size_t k = 0; k < size; ++k) {
    const Eigen::Vector3f here = cloud_.point(k);
    tree_->within(here, static_cast<float>(options_.radius), found, false);
    round.clear();
    for (const auto& neighbour : found) round.push_back(cloud_.point(neighbour.index) - here);
    const Eigen::Vector3f normal = planar::line_normal(round.data(), round.size());
    cloud_.nx[k] = normal.x(), cloud_.ny[k] = normal.y();
  }
}

IcpResult Submap::align(const Cloud& scan, const PlanarPose& start,
                        const IcpOptions& options) const {
  IcpResult result = planar::align(cloud_, *tree_, scan, newest().inverse() * start, options);
  result.T = newest() * result.T;
  return result;
}

const LikelihoodField& Submap::field() const {
  if (!field_)
    field_.emplace(cloud_.x, cloud_.y, search_resolution, search_sigma, 3 * search_sigma, 5);
  return *field_;
}

double Submap::score(const Cloud& scan, const PlanarPose& pose, const PlanarPose& start,
                     bool known) const {
  const PlanarPose T_world_submap = newest();
  const PlanarPose T = T_world_submap.inverse() * pose;
  return score_of(field(), scan.x, scan.y, T) -
         prior_at(T_world_submap.inverse() * start, known).lost(T);
}

std::optional<PlanarPose> Submap::search(const Cloud& scan, const PlanarPose& start, bool known,
                                         Breadth breadth) const {
  const PlanarPose centre = newest().inverse() * start;
  const double window =
      breadth == Breadth::near ? options_.search_window : options_.lost_search_window;
  const auto peak =
      best_pose(field(), scan.x, scan.y,
                {centre, window, window, breadth == Breadth::near ? options_.search_angle : M_PI,
                 prior_at(centre, known)},
                planar::yaw_step_for(scan.x, scan.y, search_resolution), 0);
  if (!peak) return std::nullopt;
  return newest() * peak->pose;
}

}  // namespace plumb::track_sliding_window
