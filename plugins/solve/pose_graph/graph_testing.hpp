#pragma once
/// For tests of the pose graph: a drive of many segments with known poses, drift, and pairs on its
/// edges.

#include <random>

#include "pose_graph.hpp"
#include "shared/parallel/loop_testing.hpp"

namespace plumb::solve_pose_graph {

using parallel::in_order;

struct TestGraph {
  Poses truth, drifted;
  std::vector<Edge> edges;
  std::vector<Matches> matches;

  std::vector<MatchedEdge> matched() const {
    std::vector<MatchedEdge> list;
    for (std::size_t k = 0; k < edges.size(); ++k) list.push_back({edges[k], &matches[k]});
    return list;
  }
};

inline Eigen::Vector3d gauss3(std::mt19937& random, double sigma) {
  std::normal_distribution<double> g(0, sigma);
  const double x = g(random), y = g(random), z = g(random);
  return {x, y, z};
}

/// `pairs` pairs of edge e that agree with `poses` to `noise` [m], a share `wrong` of them off by
/// metres at random.
inline Matches pairs_of(const Edge& e, const Poses& poses, int pairs, double noise, double wrong,
                        std::mt19937& random) {
  Matches m;
  std::uniform_real_distribution<double> u(-1, 1);
  const Pose T_j_i = poses.relative(e.j, e.i);
  for (int k = 0; k < pairs; ++k) {
    const Eigen::Vector3d p(20 * u(random), 20 * u(random), 4 * u(random));
    Eigen::Vector3d q = T_j_i * p + gauss3(random, noise);
    if (k < wrong * pairs) q += gauss3(random, 5);
    m.p.push_back(p.cast<float>());
    m.q.push_back(q.cast<float>());
    m.normal_q.push_back(gauss3(random, 1).normalized().cast<float>());
  }
  m.found = static_cast<std::uint32_t>(pairs);
  return m;
}

/// `laps` laps of `lap` segments round a circle, 10 m apart; drift grows with the path. Sequential
/// edges, and a loop edge from each segment to the one a lap later.
inline TestGraph circle(int lap, int laps, std::uint32_t seed, double drift = 1) {
  std::mt19937 random(seed);
  TestGraph g;
  const double radius = 10 * lap / (2 * M_PI);
  for (int k = 0; k < lap * laps; ++k) {
    const double a = 2 * M_PI * k / lap;
    g.truth.T_world_segment.push_back(
        {exp_rotation({0, 0, a}),
         Eigen::Vector3d(radius * std::sin(a), -radius * std::cos(a), 0.1 * std::sin(3 * a))});
  }
  g.drifted.T_world_segment.push_back(g.truth.T_world_segment[0]);
  const auto n = static_cast<std::uint32_t>(g.truth.size());
  for (std::uint32_t k = 1; k < n; ++k) {
    const Pose step =
        g.truth.relative(k - 1, k) *
        Pose(exp_rotation(Eigen::Vector3d(0, 0, 0.002 * drift) + gauss3(random, 0.002 * drift)),
             gauss3(random, 0.05 * drift));
    g.drifted.T_world_segment.push_back(g.drifted.T_world_segment.back() * step);
  }
  for (std::uint32_t k = 0; k < n; ++k) {
    if (k + 1 < n) g.edges.push_back({k, k + 1, EdgeKind::sequential, 1, 0});
    if (k + lap < n)
      g.edges.push_back({k, k + static_cast<std::uint32_t>(lap), EdgeKind::loop, 1, 0});
  }
  for (const auto& e : g.edges) g.matches.push_back(pairs_of(e, g.truth, 40, 0.05, 0, random));
  return g;
}

/// Rms distance [m] of the poses' places after the best rigid motion.
inline double ate(const Poses& poses, const Poses& truth) {
  Eigen::Matrix3Xd a(3, poses.size()), b(3, poses.size());
  for (std::size_t k = 0; k < poses.size(); ++k) {
    a.col(static_cast<Eigen::Index>(k)) = poses.T_world_segment[k].translation;
    b.col(static_cast<Eigen::Index>(k)) = truth.T_world_segment[k].translation;
  }
  const Eigen::Matrix4d T = Eigen::umeyama(a, b, false);
  const Eigen::Matrix3Xd d =
      (T.topLeftCorner<3, 3>() * a).colwise() + T.topRightCorner<3, 1>().col(0);
  return std::sqrt((d - b).squaredNorm() / static_cast<double>(poses.size()));
}

}  // namespace plumb::solve_pose_graph
