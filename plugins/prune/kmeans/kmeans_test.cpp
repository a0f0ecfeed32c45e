#include "kmeans.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "motion_vectors.hpp"
#include "plumb/plugin/step_testing.hpp"
#include "plumb/slam/step.hpp"

namespace plumb::prune_kmeans {
namespace {

double normal(Random& random) {
  return std::sqrt(-2 * std::log(1 - random.uniform())) *
         std::cos(2 * std::numbers::pi * random.uniform());
}
Eigen::Vector3f in_ball(Random& random, float radius) {
  Eigen::Vector3f v;
  do {
    for (int c = 0; c < 3; ++c) v[c] = radius * static_cast<float>(2 * random.uniform() - 1);
  } while (v.norm() > radius);
  return v;
}

/// Pairs of points 40 m round, `right` of them moved by `T_i_j` and 0.1 m of noise, the others
/// anywhere within 5 m of that. The right ones come first.
Matches planted(int right, int wrong, const Pose& T_i_j, std::uint64_t seed) {
  Random random(seed);
  Matches m;
  for (int k = 0; k < right + wrong; ++k) {
    const Eigen::Vector3f p = in_ball(random, 40);
    Eigen::Vector3f off = in_ball(random, 5);
    if (k < right)
      for (int c = 0; c < 3; ++c) off[c] = 0.1f * static_cast<float>(normal(random));
    m.p.push_back(p);
    m.q.push_back(Motion(T_i_j.inverse()) * Eigen::Vector3f(p + off));
    m.index_p.push_back(static_cast<std::uint32_t>(k));
  }
  m.found = static_cast<std::uint32_t>(right + wrong);
  return m;
}

double share_right(const Matches& kept, unsigned right) {
  const auto good = std::ranges::count_if(kept.index_p, [&](auto k) { return k < right; });
  return static_cast<double>(good) / static_cast<double>(kept.size());
}

/// What drift leaves between the present poses and the true ones: 1.2 m and 1 degree.
const Pose drift(exp_rotation({0, 0, 0.017}), {1.0, -0.6, 0.2});

Matches run(const Matches& matches, TestContext& context, const std::string& keep = "largest") {
  return StepUnderTest(*plumb_module())
      .with("matches", matches)
      .part("poses", Pose())
      .set("keep", keep)
      .run<Matches>("matches", context);
}

TEST(KMeans, KeepsASetAtLeast85PercentRightOf60PercentOutliers) {
  for (const std::string keep : {"largest", "densest"})
    for (std::uint64_t seed = 1; seed <= 20; ++seed)
      for (const int pairs : {100, 300, 1000}) {
        TestContext context(seed);
        const Matches kept =
            run(planted(pairs * 4 / 10, pairs * 6 / 10, drift, seed), context, keep);
        EXPECT_GE(share_right(kept, static_cast<unsigned>(pairs * 4 / 10)), 0.85) << pairs << keep;
        EXPECT_GE(kept.size(), static_cast<std::size_t>(pairs) / 20) << pairs << keep;
        EXPECT_EQ(kept.found, static_cast<unsigned>(pairs));
      }
}

TEST(KMeans, KeepsFivePairsAsTheyAreAndSaysSo) {
  TestContext context;
  const Matches five = planted(2, 3, drift, 5);
  EXPECT_EQ(run(five, context).index_p, five.index_p);
  EXPECT_EQ(context.counts["edges with too few pairs to group, kept whole"], 1u);
}

TEST(KMeans, DividesSixPairs) {
  Matches six = planted(6, 0, Pose(), 3);
  for (int k = 4; k < 6; ++k) six.p[k] += Eigen::Vector3f(4, 0, 0);
  TestContext context;
  EXPECT_THAT(run(six, context).index_p, testing::ElementsAre(0, 1, 2, 3));
  EXPECT_EQ(context.counts["pairs dropped"], 2u);
}

TEST(KMeans, LetsNoPairsThrough) {
  TestContext context;
  EXPECT_EQ(run(Matches(), context).size(), 0u);
  EXPECT_TRUE(context.counts.empty());
}

TEST(KMeans, GivesTheSameForTheSameSeed) {
  const Matches matches = planted(50, 150, drift, 9);
  TestContext a(4), b(4);
  EXPECT_EQ(run(matches, a).index_p, run(matches, b).index_p);
}

TEST(KMeans, DoesNotCareWhereTheDisplacementsLie) {
  const Matches matches = planted(80, 120, drift, 11);
  auto vectors = displacements(matches, Pose());
  const auto before = kmeans(vectors, 20, Random(3)).of;
  for (auto& v : vectors) v += Vector6d::Constant(64);
  EXPECT_EQ(kmeans(vectors, 20, Random(3)).of, before);
}

TEST(KMeans, PutsEveryVectorToItsNearestCentreAndEveryCentreInTheMiddle) {
  const auto vectors = displacements(planted(80, 220, drift, 12), Pose());
  const auto clusters = kmeans(vectors, 15, Random(1));
  ASSERT_EQ(clusters.centres.size(), 15u);
  std::vector<Vector6d> sums(15, Vector6d::Zero());
  std::vector<int> counts(15, 0);
  for (std::size_t n = 0; n < vectors.size(); ++n) {
    const double own = (vectors[n] - clusters.centres[clusters.of[n]]).norm();
    for (const auto& centre : clusters.centres) EXPECT_LE(own, (vectors[n] - centre).norm());
    sums[clusters.of[n]] += vectors[n];
    ++counts[clusters.of[n]];
  }
  for (int c = 0; c < 15; ++c) EXPECT_LT((sums[c] / counts[c] - clusters.centres[c]).norm(), 1e-12);
}

TEST(KMeans, MakesNoMoreClustersThanVectorsDiffer) {
  std::vector<Vector6d> vectors(10, Vector6d::Zero());
  vectors[7] = Vector6d::Ones();
  const auto clusters = kmeans(vectors, 5, Random(1));
  EXPECT_EQ(clusters.centres.size(), 2u);
  EXPECT_EQ(best_cluster(clusters, vectors, Keep::largest, 1, 2).size(), 9u);
}

TEST(BestCluster, TakesTheTighterOfEquallyLargeOnes) {
  std::vector<Vector6d> vectors(6, Vector6d::Zero());
  for (int k = 0; k < 6; ++k) vectors[k][0] = k < 3 ? k : 100 + 0.1 * k;
  Clusters clusters{{0, 0, 0, 1, 1, 1}, {Vector6d::Zero(), Vector6d::Zero()}};
  clusters.centres[0][0] = 1, clusters.centres[1][0] = 100.4;
  EXPECT_THAT(best_cluster(clusters, vectors, Keep::largest, 1, 2), testing::ElementsAre(3, 4, 5));
}

TEST(MotionVectors, SeeTheRotationBetweenNormals) {
  Matches m = planted(1, 0, Pose(), 1);
  m.normal_p = {Eigen::Vector3f::UnitX()};
  m.normal_q = {Eigen::Vector3f::UnitY()};
  const auto v = motions(m, Pose(), 10);
  EXPECT_LT((v[0].tail<3>() - Eigen::Vector3d(0, 0, -5 * std::numbers::pi)).norm(), 1e-5);
  m.normal_q.clear();
  EXPECT_THROW(motions(m, Pose(), 10), Error);
}

TEST(KMeans, WithMotionsTellsWallsApartThatDisplacementsDoNot) {
  Matches m = planted(40, 0, Pose(), 2);
  m.normal_p.assign(40, Eigen::Vector3f::UnitX());
  m.normal_q.assign(40, Eigen::Vector3f::UnitX());
  for (int k = 30; k < 40; ++k) m.normal_q[k] = Eigen::Vector3f::UnitY();
  TestContext context;
  const auto kept = StepUnderTest(*plumb_module())
                        .with("matches", m)
                        .part("poses", Pose())
                        .set("vector", std::string("motion"))
                        .set("pairs_per_cluster", std::int64_t(20))
                        .run<Matches>("matches", context);
  EXPECT_EQ(kept.size(), 30u);
  EXPECT_EQ(share_right(kept, 30), 1.0);
}

}  // namespace
}  // namespace plumb::prune_kmeans
