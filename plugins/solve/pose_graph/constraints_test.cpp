#include <gmock/gmock.h>

#include <Eigen/SparseCholesky>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "graph_testing.hpp"
#include "plumb/data/error.hpp"

namespace plumb::solve_pose_graph {
namespace {

struct File {
  Poses poses;
  Constraints constraints;
};

/// The vertices and edges of a file whose vertices are numbered from 0. In the plane q.vec is half
/// the angle, so the angle's information counts 4 times.
File read(const std::filesystem::path& path) {
  File file;
  std::ifstream in(path);
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    std::string tag;
    words >> tag;
    const auto pose = [&] {
      double v[7];
      for (double& x : v) words >> x;
      return Pose(Eigen::Quaterniond(v[6], v[3], v[4], v[5]).normalized(),
                  Eigen::Vector3d(v[0], v[1], v[2]));
    };
    const auto planar_pose = [&] {
      double x, y, angle;
      words >> x >> y >> angle;
      return Pose(exp_rotation({0, 0, angle}), Eigen::Vector3d(x, y, 0));
    };
    if (tag == "VERTEX_SE2") {
      int id;
      words >> id;
      file.poses.T_world_segment.push_back(planar_pose());
      file.constraints.planar = true;
    } else if (tag == "EDGE_SE2") {
      RelativePose r;
      words >> r.i >> r.j;
      r.T_i_j = planar_pose();
      r.information.setZero();
      const int axes[3] = {0, 1, 5};
      for (int a = 0; a < 3; ++a)
        for (int b = a; b < 3; ++b) {
          double value;
          words >> value;
          value *= (a == 2 ? 2 : 1) * (b == 2 ? 2 : 1);
          r.information(axes[a], axes[b]) = r.information(axes[b], axes[a]) = value;
        }
      file.constraints.relative.push_back(r);
    } else if (tag == "VERTEX_SE3:QUAT") {
      int id;
      words >> id;
      file.poses.T_world_segment.push_back(pose());
    } else if (tag == "EDGE_SE3:QUAT") {
      RelativePose r;
      words >> r.i >> r.j;
      r.T_i_j = pose();
      for (int a = 0; a < 6; ++a)
        for (int b = a; b < 6; ++b) {
          words >> r.information(a, b);
          r.information(b, a) = r.information(a, b);
        }
      file.constraints.relative.push_back(r);
    }
  }
  return file;
}

/// g2o's error of one constraint, written down once more.
Vector6d error_of(const RelativePose& r, const Pose& a, const Pose& b) {
  const Eigen::Matrix3d R = r.T_i_j.matrix().transpose() * a.matrix().transpose() * b.matrix();
  const Eigen::Vector3d t =
      r.T_i_j.matrix().transpose() *
      (a.matrix().transpose() * (b.translation - a.translation) - r.T_i_j.translation);
  const Eigen::Quaterniond q(R);
  Vector6d e;
  e << t, (q.w() < 0 ? -1 : 1) * q.vec();
  return e;
}

double cost_of(const Constraints& constraints, const Poses& poses) {
  double sum = 0;
  for (const auto& r : constraints.relative) {
    const Vector6d e = error_of(r, poses.T_world_segment[r.i], poses.T_world_segment[r.j]);
    sum += e.dot(r.information * e);
  }
  return sum;
}

/// The second computation: Gauss-Newton with derivatives by central differences and a left
/// perturbation, nothing of Ceres.
Poses gauss_newton(const Constraints& constraints, Poses poses, int steps) {
  const auto n = static_cast<Eigen::Index>(poses.size());
  const auto moved = [](const Pose& T, const Vector6d& m) {
    return Pose(exp_rotation(m.tail<3>()) * T.rotation, T.translation + m.head<3>());
  };
  for (int step = 0; step < steps; ++step) {
    std::vector<Eigen::Triplet<double>> entries;
    Eigen::VectorXd gradient = Eigen::VectorXd::Zero(6 * n);
    for (const auto& r : constraints.relative) {
      const Pose T[2] = {poses.T_world_segment[r.i], poses.T_world_segment[r.j]};
      const Eigen::Index at[2] = {6 * static_cast<Eigen::Index>(r.i),
                                  6 * static_cast<Eigen::Index>(r.j)};
      const Vector6d e = error_of(r, T[0], T[1]);
      Matrix6d J[2];
      for (int end = 0; end < 2; ++end)
        for (int k = 0; k < 6; ++k) {
          const Vector6d h = 1e-5 * Vector6d::Unit(k);
          Pose up[2] = {T[0], T[1]}, down[2] = {T[0], T[1]};
          up[end] = moved(T[end], h);
          down[end] = moved(T[end], -h);
          J[end].col(k) = (error_of(r, up[0], up[1]) - error_of(r, down[0], down[1])) / 2e-5;
        }
      for (int a = 0; a < 2; ++a) {
        gradient.segment<6>(at[a]) += J[a].transpose() * (r.information * e);
        for (int b = 0; b < 2; ++b) {
          const Matrix6d block = J[a].transpose() * r.information * J[b];
          for (int row = 0; row < 6; ++row)
            for (int col = 0; col < 6; ++col)
              entries.emplace_back(at[a] + row, at[b] + col, block(row, col));
        }
      }
    }
    for (int k = 0; k < 6; ++k) entries.emplace_back(k, k, 1e9);  // holds the first pose
    Eigen::SparseMatrix<double> H(6 * n, 6 * n);
    H.setFromTriplets(entries.begin(), entries.end());
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(H);
    const Eigen::VectorXd move = solver.solve(-gradient);
    for (Eigen::Index v = 0; v < n; ++v) {
      auto& T = poses.T_world_segment[static_cast<std::size_t>(v)];
      T = moved(T, move.segment<6>(6 * v));
    }
    if (move.norm() < 1e-5) break;
  }
  return poses;
}

GraphOptions least_squares() {
  GraphOptions options;
  options.loss = Loss::none;
  return options;
}

/// A file of the shared test graphs; empty on machines that do not have them.
std::filesystem::path graph_file(const std::string& name) {
  const char* data = std::getenv("PLUMB_DATA");
  const auto folder = data ? std::filesystem::path(data)
                           : std::filesystem::path(PLUMB_SOURCE_DIR) / "../shared/data";
  const auto path = folder / "graphs" / name;
  return std::filesystem::exists(path) ? path : std::filesystem::path();
}

class KnownGraph : public testing::TestWithParam<const char*> {};

TEST_P(KnownGraph, ReachesTheCostThatASecondComputationFinds) {
  const auto path = graph_file(GetParam());
  if (path.empty()) GTEST_SKIP() << GetParam() << " is not on this machine";
  const File file = read(path);
  const auto result =
      solve_pose_graph(file.poses, {}, &file.constraints, least_squares(), in_order);
  const double cost = cost_of(file.constraints, result.poses);
  EXPECT_NEAR(result.metrics.numbers[2].value / cost, 1, 1e-9) << "cost_after is not the cost";
  // The second computation starts somewhere else, at five times that cost and more.
  std::mt19937 random(1);
  Poses other = result.poses;
  for (auto& pose : other.T_world_segment)
    pose = pose * Pose(exp_rotation(gauss3(random, 0.03)), gauss3(random, 0.1));
  ASSERT_GT(cost_of(file.constraints, other), 5 * cost);
  const double second = cost_of(file.constraints, gauss_newton(file.constraints, other, 20));
  EXPECT_NEAR(cost / second, 1, 1e-6) << cost << " against " << second;
}

INSTANTIATE_TEST_SUITE_P(Files, KnownGraph,
                         testing::Values("parking-garage.g2o", "sphere2500.g2o"));

TEST(PlanarGraph, ReachesThePublishedOptimumOfIntelWithTheChordalError) {
  const auto path = graph_file("intel.g2o");
  if (path.empty()) GTEST_SKIP() << "intel.g2o is not on this machine";
  const File file = read(path);
  auto options = least_squares();
  options.constraint_error = ConstraintError::chordal;
  const auto result = solve_pose_graph(file.poses, {}, &file.constraints, options, in_order);
  // The certified optimum of [Rosen2019]: 52.3482.
  EXPECT_NEAR(result.metrics.numbers[2].value, 52.3482, 1e-4);
}

/// The circle of graph_testing.hpp with constraints in place of pairs.
Constraints constraints_of(const TestGraph& g, std::uint32_t seed) {
  std::mt19937 random(seed);
  Constraints constraints;
  for (const auto& e : g.edges) {
    RelativePose r{e.i, e.j, g.truth.relative(e.i, e.j), Matrix6d::Identity()};
    r.T_i_j = r.T_i_j * Pose(exp_rotation(gauss3(random, 0.002)), gauss3(random, 0.05));
    r.information.diagonal().head<3>().setConstant(std::pow(0.05, -2));
    r.information.diagonal().tail<3>().setConstant(std::pow(0.001, -2));
    constraints.relative.push_back(r);
  }
  return constraints;
}

TEST(Constraints, OfWhichATenthAreFalseLoopsAreLetGo) {
  const auto g = circle(40, 2, 1);
  auto constraints = constraints_of(g, 4);
  GraphOptions options;
  options.loss = Loss::geman_mcclure;
  options.anneal_from = 50;  // with scale 0.5 m: from 100 times constraint_scale
  const auto solved = [&] {
    return solve_pose_graph(g.drifted, {}, &constraints, options, in_order);
  };
  const double clean = ate(solved().poses, g.truth);
  std::vector<std::size_t> planted;
  for (std::size_t k = 0; k < g.edges.size(); ++k)
    if (g.edges[k].kind == EdgeKind::loop && k % 10 == 1) planted.push_back(k);
  ASSERT_GE(planted.size(), 4u);
  for (const auto k : planted)
    constraints.relative[k].T_i_j.translation += Eigen::Vector3d(9, 5, -3);
  const auto result = solved();
  EXPECT_LT(ate(result.poses, g.truth), 1.1 * clean + 1e-3);
  for (const auto k : planted) EXPECT_EQ(result.metrics.edges[k].status, "rejected");
}

/// The circle's constraints that are sequential, or the others.
Constraints only(const Constraints& all, bool sequential) {
  Constraints some;
  for (const auto& r : all.relative)
    if ((r.j == r.i + 1) == sequential) some.relative.push_back(r);
  return some;
}

TEST(Constraints, ThatAreSequentialArePriorsWithoutARecordBesideMatches) {
  const auto g = circle(20, 2, 1);
  const auto all = constraints_of(g, 4), chain = only(all, true), loops = only(all, false);
  ASSERT_EQ(chain.relative.size(), 39u);
  ASSERT_EQ(loops.relative.size(), 20u);
  const auto edges = g.matched();
  const auto records = [&](std::span<const MatchedEdge> matched, const Constraints& constraints) {
    return solve_pose_graph(g.drifted, matched, &constraints, GraphOptions(), in_order)
        .metrics.edges.size();
  };
  EXPECT_EQ(records(edges, chain), edges.size());
  EXPECT_EQ(records(edges, all), edges.size() + 20) << "loops keep theirs";
  EXPECT_EQ(records({}, all), 59u) << "and so does the chain where there are no matches";
}

TEST(Constraints, OfAChainHoldASegmentWhosePairsAreMissingBesideMatches) {
  auto g = circle(20, 2, 1);
  Constraints chain = only(constraints_of(g, 4), true);
  const auto hole = [&](const Edge& e) { return e.i == 10 || e.j == 10; };
  for (std::size_t k = 0; k < g.edges.size(); ++k)
    if (hole(g.edges[k])) g.matches[k] = Matches();
  const auto result = solve_pose_graph(g.drifted, g.matched(), &chain, GraphOptions(), in_order);
  EXPECT_TRUE(result.warnings.empty());
  for (const auto& note : result.metrics.notes)
    EXPECT_THAT(note, testing::Not(testing::HasSubstr("not joined")));
  const Pose error = g.truth.relative(9, 10).inverse() * result.poses.relative(9, 10);
  EXPECT_LT(error.translation.norm(), 0.2);
  EXPECT_EQ(
      solve_pose_graph(g.drifted, g.matched(), nullptr, GraphOptions(), in_order).warnings.size(),
      1u)
      << "without the chain it is a part of its own";
}

TEST(Constraints, TheChordalErrorGivesNearlyTheSamePoses) {
  const auto g = circle(30, 2, 2);
  const auto constraints = constraints_of(g, 5);
  auto options = least_squares();
  const auto a = solve_pose_graph(g.drifted, {}, &constraints, options, in_order);
  options.constraint_error = ConstraintError::chordal;
  const auto b = solve_pose_graph(g.drifted, {}, &constraints, options, in_order);
  EXPECT_LT(ate(a.poses, b.poses), 0.02);
}

TEST(Constraints, AbsolutePosesAndPointsPutTheGraphIntoTheirFrame) {
  const auto g = circle(20, 2, 3);
  const Pose shifted(exp_rotation({0, 0, 2}), {1000, -500, 30});
  Constraints points = constraints_of(g, 6), one_pose = points;
  for (const std::uint32_t k : {0u, 7u, 15u})
    points.points.push_back({k,
                             {1, 2, 3},
                             shifted * (g.truth.T_world_segment[k] * Eigen::Vector3d(1, 2, 3)),
                             Eigen::Matrix3d::Identity() * 1e4});
  one_pose.absolute.push_back(
      {3, shifted * g.truth.T_world_segment[3], Matrix6d::Identity() * 1e6});
  for (const auto* constraints : {&points, &one_pose}) {
    const auto result = solve_pose_graph(g.drifted, {}, constraints, least_squares(), in_order);
    double worst = 0;
    for (std::size_t k = 0; k < g.truth.size(); ++k)
      worst = std::max(worst, (result.poses.T_world_segment[k].translation -
                               (shifted * g.truth.T_world_segment[k]).translation)
                                  .norm());
    EXPECT_LT(worst, 0.5);
  }
}

TEST(Constraints, PlanarOnesLeaveHeightRollAndPitchAlone) {
  auto g = circle(20, 2, 3);
  for (auto* poses : {&g.truth, &g.drifted})
    for (auto& pose : poses->T_world_segment) {
      pose.translation.z() = 0;
      pose.rotation.x() = pose.rotation.y() = 0;
      pose.rotation.normalize();
    }
  auto constraints = constraints_of(g, 6);
  constraints.planar = true;
  const auto result = solve_pose_graph(g.drifted, {}, &constraints, least_squares(), in_order);
  for (const auto& pose : result.poses.T_world_segment) {
    EXPECT_EQ(pose.translation.z(), 0);
    EXPECT_EQ(pose.rotation.x(), 0);
  }
  EXPECT_LT(ate(result.poses, g.truth), 0.2);
}

TEST(Constraints, WithANegativeInformationAreRefused) {
  auto g = circle(5, 1, 3);
  auto constraints = constraints_of(g, 6);
  constraints.relative[0].information(2, 2) = -5;
  EXPECT_THROW(solve_pose_graph(g.drifted, {}, &constraints, least_squares(), in_order), Error);
}

}  // namespace
}  // namespace plumb::solve_pose_graph
