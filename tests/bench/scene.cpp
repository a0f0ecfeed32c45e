#include "scene.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <vector>

#include "plumb/data/io/cloud_file.hpp"
#include "plumb/data/io/trajectory_file.hpp"
#include "plumb/geometry/search_tree.hpp"
#include "plumb/plugin/context.hpp"

namespace plumb::bench {
namespace {

constexpr unsigned frames_per_segment = 5;

std::filesystem::path sequence() { return std::filesystem::path(PLUMB_TEST_DATA) / "kitti_street"; }

/// The mean of each cubic cell's points.
Cloud thinned(const Cloud& cloud, double leaf) {
  std::map<std::array<int, 3>, std::pair<Eigen::Vector3d, int>> cells;
  for (std::size_t k = 0; k < cloud.size(); ++k) {
    const Eigen::Vector3d at = (cloud.point(k).cast<double>() / leaf).array().floor();
    auto& [sum, count] =
        cells[{static_cast<int>(at.x()), static_cast<int>(at.y()), static_cast<int>(at.z())}];
    if (count++ == 0) sum.setZero();
    sum += cloud.point(k).cast<double>();
  }
  Cloud result;
  for (const auto& [cell, mean] : cells) result.add((mean.first / mean.second).cast<float>());
  return result;
}

Cloud real_segment(unsigned which) {
  const Trajectory trajectory = read_tum(sequence() / "odometry.tum");
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(sequence() / "frames"))
    files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  const std::size_t first = which * frames_per_segment % (files.size() - frames_per_segment);
  const Pose T_segment_world = trajectory.T_world_frame[first + frames_per_segment / 2].inverse();
  Cloud merged;
  for (std::size_t k = first; k < first + frames_per_segment; ++k) {
    const Cloud cloud = read_pcd(files[k]).cloud;
    const Motion motion(T_segment_world * trajectory.T_world_frame[k]);
    for (std::size_t m = 0; m < cloud.size(); ++m) merged.add(motion * cloud.point(m));
  }
  return merged;
}

Cloud made_segment(unsigned which) {
  Random random(which + 1);
  const auto uniform = [&](double low, double high) {
    return static_cast<float>(low + (high - low) * random.uniform());
  };
  Cloud cloud;
  for (int k = 0; k < 150000; ++k)
    cloud.add({uniform(-60, 60), uniform(-20, 20), uniform(-0.03, 0.03)});
  for (int k = 0; k < 150000; ++k)
    cloud.add({uniform(-60, 60), (k % 2 ? 12 : -12) + uniform(-0.03, 0.03) + (k / 2 % 16) * 0.2f,
               uniform(0, 10)});
  for (int k = 0; k < 30000; ++k) {
    const float x = -50 + 7.0f * static_cast<float>(k % 15), turn = uniform(0, 6.28);
    cloud.add({x + 0.9f * std::cos(turn), 6 + 1.2f * std::sin(turn), uniform(0, 1.7)});
  }
  return cloud;
}

}  // namespace

std::string scene_name() {
  return std::filesystem::exists(sequence()) ? "kitti_street" : "made street";
}

Cloud street_segment(unsigned which, double leaf) {
  return thinned(std::filesystem::exists(sequence()) ? real_segment(which) : made_segment(which),
                 leaf);
}

Cloud street_segment_with_normals(unsigned which, double leaf) {
  Cloud cloud = street_segment(which, leaf);
  const SearchTree tree(cloud);
  cloud.nx.assign(cloud.size(), 0), cloud.ny.assign(cloud.size(), 0),
      cloud.nz.assign(cloud.size(), 0);
  for (std::size_t k = 0; k < cloud.size(); ++k) {
    SearchTree::Neighbour near[30];
    std::size_t count = tree.nearest(cloud.point(k), 30, near);
    while (count > 0 && near[count - 1].squared_distance > 1) --count;
    if (count < 3) continue;
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (std::size_t m = 0; m < count; ++m)
      mean += cloud.point(near[m].index).cast<double>() / static_cast<double>(count);
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    for (std::size_t m = 0; m < count; ++m) {
      const Eigen::Vector3d off = cloud.point(near[m].index).cast<double>() - mean;
      spread += off * off.transpose();
    }
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(spread);
    Eigen::Vector3f normal = eigen.eigenvectors().col(0).cast<float>();
    if (normal.dot(cloud.point(k)) > 0) normal = -normal;
    cloud.nx[k] = normal.x(), cloud.ny[k] = normal.y(), cloud.nz[k] = normal.z();
  }
  return cloud;
}

}  // namespace plumb::bench
