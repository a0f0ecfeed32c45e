#include "refine.hpp"

#include <gmock/gmock.h>

#include <Eigen/Eigenvalues>

#include "yard_testing.hpp"

namespace plumb::register_features {
namespace {

constexpr double degree = M_PI / 180;

const Pose T_world_i(exp_rotation({0.01, -0.02, 0.3}), {2, -1, 1.5}),
    T_world_j(exp_rotation({-0.02, 0.01, 2.0}), {-3, 2, 1.8});
const Pose T_j_i = T_world_j.inverse() * T_world_i;

Eigen::Vector3d random_vector(std::mt19937& random, double length) {
  std::normal_distribution<double> g;
  const double x = g(random), y = g(random), z = g(random);
  return length * Eigen::Vector3d(x, y, z).normalized();
}

/// A wrong T_j_i: `metres` and `radians` from the right one, as seen in the middle of i.
Pose off_by(double metres, double radians, std::mt19937& random) {
  return T_j_i * Pose(exp_rotation(random_vector(random, radians)), random_vector(random, metres));
}

TEST(Refined, FindsTheMotionFromAMetreAndThreeDegreesAway) {
  for (std::uint32_t seed = 1; seed <= 8; ++seed) {
    std::mt19937 random(seed);
    const Segment i = seen_from(T_world_i, yard(seed)), j = seen_from(T_world_j, yard(seed + 100));
    const Registration found = refined(i, j, off_by(1, 3 * degree, random), {});
    const Pose error = T_j_i * found.T_i_j;
    EXPECT_LT(error.translation.norm(), 0.02) << seed;
    EXPECT_LT(angle(error), 0.1 * degree) << seed;
    EXPECT_GT(found.overlap, 0.8f) << seed;
    EXPECT_LT(found.mae, 0.05f) << seed;
    EXPECT_GT(found.pairs, 1500u) << seed;
  }
}

TEST(Refined, IsTheInverseWhereTheEndsChangePlaces) {
  std::mt19937 random(1);
  const Segment i = seen_from(T_world_i, yard(1)), j = seen_from(T_world_j, yard(2));
  const Pose start = off_by(0.5, 2 * degree, random);
  const Pose difference = refined(i, j, start, {}).T_i_j * refined(j, i, start.inverse(), {}).T_i_j;
  EXPECT_LT(difference.translation.norm(), 0.02);
  EXPECT_LT(angle(difference), 0.1 * degree);
}

TEST(Refined, CountsTheOverlapInTheCommonBoxOnly) {
  // i has the western three quarters of the yard, j the eastern ones.
  Cloud world_i = yard(1), world_j = yard(2);
  std::vector<std::uint32_t> west, east;
  for (std::uint32_t k = 0; k < world_i.size(); ++k)
    if (world_i.x[k] < 10) west.push_back(k);
  for (std::uint32_t k = 0; k < world_j.size(); ++k)
    if (world_j.x[k] > -10) east.push_back(k);
  const Segment i = segment_of(select(world_i, west)), j = segment_of(select(world_j, east));
  EXPECT_GT(refined(i, j, Pose(), {}).overlap, 0.8f);
}

TEST(Refined, SeesThatLittleOfAnotherPlaceLiesOnASurface) {
  // Walls stand where there is none in the other cloud, and the ground is two storeys lower.
  const Segment i = segment_of(yard(1)),
                j = seen_from(Pose(exp_rotation({0, 0, 2}), {6, 3, 6}), yard(2));
  EXPECT_LT(refined(i, j, Pose(), {}).overlap, 0.3f);
}

TEST(Refined, TakesTheLesserShareForTheOverlap) {
  // All of a house lies on a surface of the yard, but only a part of the yard in the house's box
  // lies on the house.
  Cloud house, busy;
  std::mt19937 random(1);
  add_block(house, {{0, 0, 0}, {8, 8, 6}}, 20, 0, random);
  add_block(busy, {{0, 0, 0}, {8, 8, 6}}, 20, 0, random);
  add_block(busy, {{2, 2, 0}, {6, 6, 5}}, 40, 0, random);
  const float both = refined(segment_of(house), segment_of(busy), Pose(), {}).overlap;
  EXPECT_LT(both, 0.75f);
  EXPECT_GT(both, 0.25f);
  EXPECT_NEAR(refined(segment_of(busy), segment_of(house), Pose(), {}).overlap, both, 0.02f);
  EXPECT_GT(refined(segment_of(house), segment_of(house), Pose(), {}).overlap, 0.99f);
}

TEST(Refined, PairsNoSidesOfAWallThatLookAwayFromEachOther) {
  const Segment i = seen_from(T_world_i, yard(1));
  Cloud flipped = yard(2);
  for (auto* axis : {&flipped.nx, &flipped.ny, &flipped.nz})
    for (float& n : *axis) n = -n;
  const Registration found = refined(i, seen_from(T_world_j, flipped), T_j_i, {});
  EXPECT_LT(found.overlap, 0.05f);
}

TEST(Refined, KnowsNothingWhereThereAreNoPairs) {
  const Segment i = seen_from(T_world_i, yard(1)), empty;
  const Pose far = Pose(Eigen::Quaterniond::Identity(), {500, 0, 0}) * T_j_i;
  for (const Registration& found : {refined(i, seen_from(T_world_j, yard(2)), far, {}),
                                    refined(i, empty, far, {}), refined(empty, i, far, {})}) {
    EXPECT_EQ(found.pairs, 0u);
    EXPECT_EQ(found.overlap, 0);
    EXPECT_TRUE(found.information.isZero(0));
    EXPECT_LT(((found.T_i_j * far).translation).norm(), 1e-9);
  }
}

// ---- information
// ------------------------------------------------------------------------------------------------------------

/// All of i's points in j's box with j's nearest, compared one with each other.
struct BrutePair {
  Eigen::Vector3d p, q, normal;
};
std::vector<BrutePair> brute_pairs(const Segment& i, const Segment& j, const Pose& T,
                                   const RefineOptions& options) {
  std::vector<BrutePair> pairs;
  for (std::size_t k = 0; k < i.cloud.size(); ++k) {
    const Eigen::Vector3d p = i.cloud.point(k).cast<double>(), at = T * p;
    double least = options.max_correspondence_distance;
    std::size_t nearest = j.cloud.size();
    for (std::size_t n = 0; n < j.cloud.size(); ++n)
      if (const double d = (j.cloud.point(n).cast<double>() - at).norm(); d < least)
        least = d, nearest = n;
    if (nearest == j.cloud.size()) continue;
    const Eigen::Vector3d normal = j.cloud.normal(nearest).cast<double>();
    if ((T.rotation * i.cloud.normal(k).cast<double>()).dot(normal) <
        std::cos(options.max_normal_angle))
      continue;
    pairs.push_back({p, j.cloud.point(nearest).cast<double>(), normal});
  }
  return pairs;
}

/// The second way: half of the second differences of the sum of squares, T_i_j moving by (v, w) in
/// j's axes.
TEST(RefinedInformation, IsTheCurvatureOfTheSumOfSquares) {
  const Segment i = seen_from(T_world_i, yard(1, 0, 1)), j = seen_from(T_world_j, yard(2, 0, 1));
  RefineOptions options;
  options.max_points = 100000;
  const double independent = 80;
  const Registration found = refined(i, j, T_j_i, options, independent);
  const auto pairs = brute_pairs(i, j, found.T_i_j.inverse(), options);
  ASSERT_EQ(pairs.size(), found.pairs);
  const auto cost = [&](const Vector6d& move) {
    const Pose T = (found.T_i_j * Pose(exp_rotation(move.tail<3>()), move.head<3>())).inverse();
    double sum = 0;
    for (const auto& pair : pairs) sum += std::pow(pair.normal.dot(T * pair.p - pair.q), 2);
    return sum;
  };
  Matrix6d curvature;
  const double h = 1e-3;
  for (int a = 0; a < 6; ++a)
    for (int b = 0; b < 6; ++b) {
      const Vector6d x = h * Vector6d::Unit(a), y = h * Vector6d::Unit(b);
      curvature(a, b) = (cost(x + y) - cost(x - y) - cost(y - x) + cost(-x - y)) / (8 * h * h);
    }
  // Without noise the distances to the planes are under 1 cm, which is what counts then.
  curvature *= independent / static_cast<double>(pairs.size()) / 1e-4;
  EXPECT_LT((found.information - curvature).norm(), 1e-3 * curvature.norm());
}

TEST(RefinedInformation, IsNoneAlongACorridor) {
  std::mt19937 random(1);
  Cloud world;
  add_rectangle(world, {-20, 0, 0}, {40, 0, 0}, {0, 4, 0}, 8, 0.01, random);
  add_rectangle(world, {-20, 4, 0}, {40, 0, 0}, {0, 0, 3}, 8, 0.01, random);
  add_rectangle(world, {-20, 0, 0}, {0, 0, 3}, {40, 0, 0}, 8, 0.01, random);
  // The corridor leads along j's y.
  const Pose T_world(exp_rotation({0, 0, M_PI / 2}), {1, 2, 1});
  const Matrix6d information =
      refined(segment_of(world), seen_from(T_world, world), T_world.inverse(), {}).information;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(information.topLeftCorner<3, 3>());
  EXPECT_LT(eigen.eigenvalues()[0], 1e-3 * eigen.eigenvalues()[1]);
  EXPECT_GT(std::abs(eigen.eigenvectors()(1, 0)), 0.99);
}

TEST(RefinedInformation, GrowsWithTheNumberOfIndependentPairsUpToAll) {
  const Segment i = seen_from(T_world_i, yard(1)), j = seen_from(T_world_j, yard(2));
  const Registration few = refined(i, j, T_j_i, {}, 50), more = refined(i, j, T_j_i, {}, 100);
  EXPECT_LT((more.information - 2 * few.information).norm(), 1e-9 * more.information.norm());
  EXPECT_EQ(refined(i, j, T_j_i, {}, 1e6).information, refined(i, j, T_j_i, {}, 1e9).information);
}

/// With errors that are independent indeed, squared errors measured by the information have the
/// mean 6.
TEST(RefinedInformation, ForetellsTheErrorWherePairsAreIndependent) {
  double sum = 0;
  constexpr int runs = 20;
  for (std::uint32_t seed = 1; seed <= runs; ++seed) {
    const Segment i = seen_from(T_world_i, yard(seed, 0.05)),
                  j = seen_from(T_world_j, yard(seed + 100, 0.05));
    const Registration found = refined(i, j, T_j_i, {}, 1e9);
    const Pose error = found.T_i_j.inverse() * T_j_i.inverse();
    Vector6d e;
    e << error.translation, log_rotation(error.rotation);
    sum += e.dot(found.information * e) / runs;
  }
  EXPECT_GT(sum, 3);
  EXPECT_LT(sum, 12);
}

}  // namespace
}  // namespace plumb::register_features
