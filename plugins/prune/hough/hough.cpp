#include "hough.hpp"

#include <pcl/features/shot_lrf.h>
#include <pcl/recognition/cg/hough_3d.h>

#include <algorithm>
#include <limits>

#include "plumb/data/error.hpp"
#include "plumb/data/short_number.hpp"
#include "plumb/slam/geometry/box.hpp"
#include "shared/pcl/clouds.hpp"

namespace plumb::prune_hough {
namespace {

constexpr double most_bins = 1 << 24;  // PCL's grid is dense

using ReferenceFrames = ::pcl::PointCloud<::pcl::ReferenceFrame>;

std::vector<Eigen::Matrix3f> frames_at(const std::vector<Eigen::Vector3f>& points,
                                       const Cloud& cloud, double radius) {
  ::pcl::SHOTLocalReferenceFrameEstimation<::pcl::PointXYZ, ::pcl::ReferenceFrame> estimate;
  estimate.setInputCloud(pcl::points_of(points));
  estimate.setSearchSurface(pcl::points_of(cloud));
  estimate.setRadiusSearch(radius);
  ReferenceFrames frames;
  estimate.compute(frames);
  std::vector<Eigen::Matrix3f> result;
  for (const auto& frame : frames) result.push_back(frame.getMatrix3fMap());
  return result;
}

/// What PCL is given: pairs as two clouds with frames, point k of one with point k of the other.
struct Pairs {
  pcl::Points::Ptr p{new pcl::Points}, q{new pcl::Points};
  ReferenceFrames::Ptr at_p{new ReferenceFrames}, at_q{new ReferenceFrames};

  void add(const Eigen::Vector3f& point_p, const Eigen::Vector3f& point_q,
           const Eigen::Matrix3f& frame_p, const Eigen::Matrix3f& frame_q) {
    p->emplace_back(point_p.x(), point_p.y(), point_p.z());
    q->emplace_back(point_q.x(), point_q.y(), point_q.z());
    ::pcl::ReferenceFrame frame;
    frame.getMatrix3fMap() = frame_p;
    at_p->push_back(frame);
    frame.getMatrix3fMap() = frame_q;
    at_q->push_back(frame);
  }
};

/// The pairs of `voters`, then two that make PCL's grid, which ends where the votes end, a bin
/// wider all round: else it had none along an axis along which all votes are the same.
Pairs pairs_of(const Matches& matches, const PairFrames& frames,
               const std::vector<std::uint32_t>& voters, double bin_size) {
  Eigen::Vector3f centre = Eigen::Vector3f::Zero();
  for (const auto k : voters) centre += matches.q[k] / static_cast<float>(voters.size());
  Box box;
  Pairs pairs;
  for (const auto k : voters) {
    box.add(matches.p[k] + frames.at_p[k] * (frames.at_q[k].transpose() * (centre - matches.q[k])));
    pairs.add(matches.p[k], matches.q[k], frames.at_p[k], frames.at_q[k]);
  }
  const Eigen::Vector3d bins = (box.high - box.low).cast<double>().array() / bin_size + 3;
  if (bins.prod() > most_bins)
    throw Error("the pairs vote over " + short_number((box.high - box.low).maxCoeff()) +
                " m, which is more than 2^24 bins of " + short_number(bin_size) +
                " m: put prune.distance before this step, or take a larger hough_bin_size");
  const Eigen::Vector3f margin = Eigen::Vector3f::Constant(static_cast<float>(bin_size));
  const Eigen::Matrix3f same = Eigen::Matrix3f::Identity();
  pairs.add(box.low - margin, centre, same, same);
  pairs.add(box.high + margin, centre, same, same);
  return pairs;
}

}  // namespace

PairFrames frames_of_pose(std::size_t pairs, const Pose& T_i_j) {
  return {std::vector<Eigen::Matrix3f>(pairs, Motion(T_i_j).r),
          std::vector<Eigen::Matrix3f>(pairs, Eigen::Matrix3f::Identity())};
}

PairFrames local_frames(const Matches& matches, const Cloud& i, const Cloud& j, double radius) {
  if (matches.size() == 0 || i.empty() || j.empty()) {
    const Eigen::Matrix3f none = Eigen::Matrix3f::Constant(std::numeric_limits<float>::quiet_NaN());
    const std::vector<Eigen::Matrix3f> nowhere(matches.size(), none);
    return {nowhere, nowhere};
  }
  return {frames_at(matches.p, i, radius), frames_at(matches.q, j, radius)};
}

std::vector<std::uint32_t> most_voted(const Matches& matches, const PairFrames& frames,
                                      const HoughOptions& options) {
  std::vector<std::uint32_t> voters;
  for (std::uint32_t k = 0; k < matches.size(); ++k)
    if (frames.at_p[k].allFinite() && frames.at_q[k].allFinite()) voters.push_back(k);
  if (voters.empty()) return {};
  const Pairs pairs = pairs_of(matches, frames, voters, options.hough_bin_size);

  ::pcl::CorrespondencesPtr correspondences(new ::pcl::Correspondences);
  for (::pcl::index_t k = 0; k < static_cast<::pcl::index_t>(pairs.p->size()); ++k)
    correspondences->emplace_back(k, k, 0.0f);
  ::pcl::Hough3DGrouping<::pcl::PointXYZ, ::pcl::PointXYZ> grouping;
  grouping.setInputCloud(pairs.q);
  grouping.setInputRf(pairs.at_q);
  grouping.setSceneCloud(pairs.p);
  grouping.setSceneRf(pairs.at_p);
  grouping.setModelSceneCorrespondences(correspondences);
  grouping.setHoughBinSize(options.hough_bin_size);
  grouping.setHoughThreshold(options.hough_threshold);
  grouping.setUseInterpolation(true);
  std::vector<::pcl::Correspondences> sets;
  grouping.cluster(sets);

  const auto largest = std::max_element(
      sets.begin(), sets.end(), [](const auto& a, const auto& b) { return a.size() < b.size(); });
  std::vector<std::uint32_t> kept;
  if (largest == sets.end()) return kept;
  for (const auto& pair : *largest)
    if (const auto k = static_cast<std::size_t>(pair.index_query); k < voters.size())
      kept.push_back(voters[k]);
  std::sort(kept.begin(), kept.end());
  return kept;
}

}  // namespace plumb::prune_hough
