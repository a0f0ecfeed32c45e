#include "consensus.hpp"

#include <gmock/gmock.h>

#include <Eigen/Geometry>

#include "plumb/slam/cloud_testing.hpp"

namespace plumb::register_features {
namespace {

const Pose T_j_i(exp_rotation({0.2, -0.4, 2.5}), {40, -25, 3});

/// `right` pairs that follow T_j_i to within `noise` on each axis, then `wrong` ones of unrelated
/// points.
Matches planted(int right, int wrong, std::uint64_t seed, float noise = 0.1f) {
  Random random(seed);
  Matches m;
  for (int k = 0; k < right + wrong; ++k) {
    m.p.push_back(in_cube(random, 30));
    m.q.push_back(k < right ? Eigen::Vector3f(Motion(T_j_i) * m.p.back() + in_cube(random, noise))
                            : Eigen::Vector3f(Motion(T_j_i) * in_cube(random, 30)));
  }
  return m;
}

TEST(Consensus, FindsTheMotionAmong90PercentWrongPairs) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const Consensus found = consensus_of(planted(50, 450, seed), {});
    const Pose error = T_j_i.inverse() * found.T_j_i;
    EXPECT_LT(error.translation.norm(), 0.3) << seed;
    EXPECT_LT(angle(error), 0.01) << seed;
    ASSERT_GE(found.inliers.size(), 50u) << seed;
    EXPECT_LE(found.inliers.size(), 53u) << seed;
    for (std::uint32_t k = 0; k < 50; ++k) EXPECT_EQ(found.inliers[k], k);
  }
}

/// The judge fits a motion to every three pairs.
TEST(Consensus, HasAsManyInliersAsTheBestOfAllTriples) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const Matches m = planted(8, 17, seed);
    const auto n = static_cast<int>(m.size());
    std::size_t most = 0;
    for (int a = 0; a < n; ++a)
      for (int b = a + 1; b < n; ++b)
        for (int c = b + 1; c < n; ++c) {
          Eigen::Matrix3d p, q;
          int column = 0;
          for (const int k : {a, b, c}) {
            p.col(column) = m.p[static_cast<std::size_t>(k)].cast<double>();
            q.col(column++) = m.q[static_cast<std::size_t>(k)].cast<double>();
          }
          const Eigen::Isometry3d T(Eigen::umeyama(p, q, false));
          std::size_t agree = 0;
          for (std::size_t k = 0; k < m.size(); ++k)
            agree += (T * m.p[k].cast<double>() - m.q[k].cast<double>()).norm() <= 0.6;
          most = std::max(most, agree);
        }
    EXPECT_EQ(consensus_of(m, {}).inliers.size(), most) << seed;
  }
}

TEST(Consensus, FitsAsUmeyamaDoes) {
  // All 13 pairs are compatible, so that they are all in the sample.
  const Matches m = planted(13, 0, 3);
  Eigen::Matrix3Xd p(3, 13), q(3, 13);
  for (int k = 0; k < 13; ++k) {
    p.col(k) = m.p[static_cast<std::size_t>(k)].cast<double>();
    q.col(k) = m.q[static_cast<std::size_t>(k)].cast<double>();
  }
  const Eigen::Matrix4d judge = Eigen::umeyama(p, q, false);
  const Consensus found = consensus_of(m, {0.6, 0.01, 1500, 60});
  ASSERT_EQ(found.inliers.size(), 13u);
  EXPECT_LT((found.T_j_i.matrix() - judge.topLeftCorner<3, 3>()).norm(), 1e-12);
  EXPECT_LT((found.T_j_i.translation - judge.topRightCorner<3, 1>()).norm(), 1e-11);
}

TEST(Consensus, FitsARotationToPointsInAPlaneAndNoReflection) {
  Matches m = planted(30, 0, 4);
  for (std::size_t k = 0; k < m.size(); ++k) {
    m.p[k].z() = 0;
    m.q[k] = Motion(T_j_i) * m.p[k];
  }
  const Consensus found = consensus_of(m, {});
  EXPECT_EQ(found.inliers.size(), 30u);
  EXPECT_LT(angle(T_j_i.inverse() * found.T_j_i), 1e-5);
}

TEST(Consensus, HasInliersThatFitAndLeavesOutNoneThatDoes) {
  const Matches m = planted(60, 200, 5, 0.5f);
  const Consensus found = consensus_of(m, {});
  std::vector<std::uint32_t> fitting;
  for (std::uint32_t k = 0; k < m.size(); ++k)
    if ((found.T_j_i * m.p[k].cast<double>() - m.q[k].cast<double>()).norm() <= 0.6)
      fitting.push_back(k);
  EXPECT_EQ(found.inliers, fitting);
}

TEST(Consensus, IsTheSameWhereverTheSegmentsLie) {
  const Matches m = planted(40, 160, 6);
  Matches moved = m;
  for (auto& p : moved.p) p += Eigen::Vector3f(64, -32, 16);
  const Consensus a = consensus_of(m, {}), b = consensus_of(moved, {});
  EXPECT_EQ(a.inliers, b.inliers);
  const Pose expected = a.T_j_i * Pose(Eigen::Quaterniond::Identity(), {-64, 32, -16});
  EXPECT_LT((expected.translation - b.T_j_i.translation).norm(), 1e-3);
}

TEST(Consensus, IsFoundInSomeOfThePairsAndCountedInAll) {
  // 300 of 3,000 are looked at, 60 of them right.
  Matches m = planted(600, 2400, 7), mixed;
  for (std::size_t k = 0; k < m.size(); ++k) {
    const std::size_t from = k % 5 == 0 ? k / 5 : 600 + k - k / 5 - 1;
    mixed.p.push_back(m.p[from]);
    mixed.q.push_back(m.q[from]);
  }
  ConsensusOptions options;
  options.max_pairs = 298;  // no divisor of what the right ones are spread by
  const Consensus found = consensus_of(mixed, options);
  EXPECT_GE(found.inliers.size(), 600u);
  EXPECT_LT((T_j_i.inverse() * found.T_j_i).translation.norm(), 0.3);
}

TEST(Consensus, IsNotFoundWherePairsFitNoMotion) {
  EXPECT_LT(consensus_of(planted(0, 300, 8), {}).inliers.size(), 12u);
  Matches stretched = planted(40, 0, 9);
  for (auto& p : stretched.p) p *= 3;
  EXPECT_LT(consensus_of(stretched, {}).inliers.size(), 6u);
}

TEST(Consensus, IsNotFoundInPointsThatLieTooNearEachOther) {
  Random random(10);
  Matches m;
  for (int k = 0; k < 50; ++k) {
    m.p.push_back(in_cube(random, 1));
    m.q.push_back(Motion(T_j_i) * m.p.back());
  }
  EXPECT_TRUE(consensus_of(m, {}).inliers.empty());  // no two are 4 m apart
}

TEST(Consensus, IsNotFoundInFewerThanThreePairs) {
  EXPECT_TRUE(consensus_of(Matches(), {}).inliers.empty());
  EXPECT_TRUE(consensus_of(planted(2, 0, 1), {}).inliers.empty());
}

TEST(Consensus, TakesTheLargerOfTwoGroups) {
  Matches m = planted(30, 0, 11);
  const Matches other = planted(40, 0, 12);
  const Pose away(exp_rotation({0, 0, 1}), {10, 0, 0});
  for (std::size_t k = 0; k < other.size(); ++k) {
    m.p.push_back(other.p[k]);
    m.q.push_back(Motion(away) * other.q[k]);
  }
  const Consensus found = consensus_of(m, {});
  EXPECT_LT(((away * T_j_i).inverse() * found.T_j_i).translation.norm(), 0.3);
  EXPECT_GE(found.inliers.size(), 40u);
}

}  // namespace
}  // namespace plumb::register_features
