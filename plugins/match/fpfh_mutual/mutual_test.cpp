#include "mutual.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "plumb/plugin/context.hpp"

namespace plumb::match_fpfh_mutual {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::Pair;

/// Vectors like FPFH: most of the mass in few bins, round some centres.
std::vector<float> vectors(std::size_t count, std::uint64_t seed, double spread = 5) {
  Random random(seed), centre(99);
  std::vector<float> centres(20 * 33);
  for (auto& value : centres) value = static_cast<float>(std::pow(centre.uniform(), 6) * 100);
  std::vector<float> result;
  for (std::size_t k = 0; k < count; ++k) {
    const auto c = random.below(20);
    for (std::size_t d = 0; d < 33; ++d)
      result.push_back(centres[c * 33 + d] + static_cast<float>(spread * (random.uniform() - 0.5)));
  }
  return result;
}

TEST(MutualNearest, IsWhatComparingAllPairsGives) {
  for (const auto& [n, m] : {std::pair{1, 1}, {5, 17}, {6, 16}, {7, 300}, {301, 18}, {700, 650}}) {
    const auto a = vectors(static_cast<std::size_t>(n), 1),
               b = vectors(static_cast<std::size_t>(m), 2);
    EXPECT_EQ(mutual_nearest(a, b, 33), mutual_nearest_plainly(a, b, 33)) << n << " x " << m;
  }
}

TEST(MutualNearest, IsExactWhereDistancesAreFarBelowTheRoundingOfLongVectors) {
  // Lengths of about 200, differences of 1e-4: the product form in float sees nothing of them.
  const auto a = vectors(400, 3, 1e-4), b = vectors(400, 4, 1e-4);
  EXPECT_EQ(mutual_nearest(a, b, 33), mutual_nearest_plainly(a, b, 33));
}

TEST(MutualNearest, IsExactAmongEqualVectors) {
  auto a = vectors(100, 5), b = a;
  b.insert(b.end(), a.begin(), a.end());
  a.insert(a.begin(), b.begin(), b.begin() + 33 * 50);
  const auto pairs = mutual_nearest(a, b, 33);
  EXPECT_EQ(pairs, mutual_nearest_plainly(a, b, 33));
  EXPECT_EQ(pairs.size(), 100u);  // each twin pairs with the twin of the lowest index
}

TEST(MutualNearest, OfASetWithItselfIsTheIdentity) {
  const auto a = vectors(500, 6);
  const auto pairs = mutual_nearest(a, a, 33);
  ASSERT_EQ(pairs.size(), 500u);
  for (const auto& [i, j] : pairs) EXPECT_EQ(i, j);
}

TEST(MutualNearest, IsTheSameTheOtherWayRound) {
  const auto a = vectors(300, 7), b = vectors(400, 8);
  auto back = mutual_nearest(b, a, 33);
  for (auto& [i, j] : back) std::swap(i, j);
  std::sort(back.begin(), back.end());
  EXPECT_EQ(mutual_nearest(a, b, 33), back);
}

TEST(MutualNearest, TakesAnyDimension) {
  const std::vector<float> a{0, 10, 20}, b{19, 1, 2};
  EXPECT_THAT(mutual_nearest(a, b, 1), ElementsAre(Pair(0, 1), Pair(2, 0)));
}

TEST(MutualNearest, IsExactInAsManyDimensionsAsShotHas) {
  constexpr std::size_t dimension = 352;
  Random random(12);
  std::vector<float> a, b;
  for (std::size_t k = 0; k < 90 * dimension; ++k)
    a.push_back(static_cast<float>(std::pow(random.uniform(), 8)));
  for (std::size_t k = 0; k < 70 * dimension; ++k)
    b.push_back(a[k] + static_cast<float>(0.3 * random.uniform()));
  const auto pairs = mutual_nearest(a, b, dimension);
  EXPECT_EQ(pairs, mutual_nearest_plainly(a, b, dimension));
  EXPECT_GT(pairs.size(), 30u);
}

TEST(MutualNearest, LeavesOutVectorsThatAreNoNumbers) {
  auto a = vectors(20, 9), b = vectors(30, 10);
  a[40] = std::numeric_limits<float>::quiet_NaN();
  b[70] = std::numeric_limits<float>::infinity();
  const auto pairs = mutual_nearest(a, b, 33);
  EXPECT_EQ(pairs, mutual_nearest_plainly(a, b, 33));
  for (const auto& [i, j] : pairs) {
    EXPECT_NE(i, 1u);
    EXPECT_NE(j, 2u);
  }
}

TEST(MutualNearest, OfNothingIsNothing) {
  EXPECT_THAT(mutual_nearest({}, vectors(3, 1), 33), IsEmpty());
  EXPECT_THAT(mutual_nearest(vectors(3, 1), {}, 33), IsEmpty());
}

}  // namespace
}  // namespace plumb::match_fpfh_mutual
