#include "scene.hpp"

#include <Eigen/Eigenvalues>
#include <array>
#include <map>
#include <optional>

#include "plumb/slam/geometry/search_tree.hpp"
#include "simulate/simulate.hpp"

namespace plumb::bench {
namespace {

constexpr std::size_t segments = 2, frames_each = 5;

bool small = false;

const simulate::Stage& stage() {
  static const simulate::Stage made = [] {
    simulate::Scene scene;
    scene.path = "out_and_back";
    scene.frames = 40;
    scene.length = 3.4 * 39;
    if (small) scene.columns = 48;
    return simulate::set_up(scene);
  }();
  return made;
}

std::size_t middle(std::size_t which) { return which * frames_each + frames_each / 2; }

Cloud merged(std::size_t which) {
  Cloud cloud;
  for (std::size_t k = which * frames_each; k < (which + 1) * frames_each; ++k) {
    const Cloud frame = stage().frame(k);
    const Motion motion(segment_pose(which).inverse() * stage().truth.T_world_frame[k]);
    for (std::size_t m = 0; m < frame.size(); ++m) cloud.add(motion * frame.point(m));
  }
  return cloud;
}

/// The mean of each cubic cell's points.
Cloud thinned(const Cloud& cloud, double leaf) {
  std::map<std::array<int, 3>, std::pair<Eigen::Vector3d, int>> cells;
  for (std::size_t k = 0; k < cloud.size(); ++k) {
    const Eigen::Vector3d p = cloud.point(k).cast<double>();
    const Eigen::Vector3i at = (p / leaf).array().floor().cast<int>();
    auto& [sum, count] = cells[{at.x(), at.y(), at.z()}];
    if (count++ == 0) sum.setZero();
    sum += p;
  }
  Cloud result;
  for (const auto& [cell, mean] : cells) result.add((mean.first / mean.second).cast<float>());
  return result;
}

void add_normals(Cloud& cloud) {
  const SearchTree tree(cloud);
  for (std::size_t k = 0; k < cloud.size(); ++k) {
    SearchTree::Neighbour near[30];
    std::size_t count = tree.nearest(cloud.point(k), 30, near);
    while (count > 0 && near[count - 1].squared_distance > 1) --count;
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (std::size_t m = 0; m < count; ++m) {
      const Eigen::Vector3d off = (cloud.point(near[m].index) - cloud.point(k)).cast<double>();
      mean += off / static_cast<double>(count);
      spread += off * off.transpose() / static_cast<double>(count);
    }
    spread -= mean * mean.transpose();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(spread);
    Eigen::Vector3f normal = eigen.eigenvectors().col(0).cast<float>();
    if (normal.dot(cloud.point(k)) > 0) normal = -normal;
    if (count < 3) normal.setZero();
    cloud.nx.push_back(normal.x()), cloud.ny.push_back(normal.y()), cloud.nz.push_back(normal.z());
  }
}

}  // namespace

void make_scene_small() { small = true; }

Pose segment_pose(std::size_t which) { return stage().truth.T_world_frame[middle(which)]; }

const Cloud& merged_segment(std::size_t which) {
  static std::array<std::optional<Cloud>, segments> made;
  if (!made[which]) made[which] = merged(which);
  return *made[which];
}

const Cloud& thinned_segment(std::size_t which, double leaf) {
  static std::map<std::pair<std::size_t, double>, Cloud> made;
  auto& cloud = made[{which, leaf}];
  if (cloud.empty()) cloud = thinned(merged_segment(which), leaf);
  return cloud;
}

const Cloud& segment_with_normals(std::size_t which, double leaf) {
  static std::map<std::pair<std::size_t, double>, Cloud> made;
  auto& cloud = made[{which, leaf}];
  if (cloud.empty()) {
    cloud = thinned_segment(which, leaf);
    add_normals(cloud);
  }
  return cloud;
}

}  // namespace plumb::bench
