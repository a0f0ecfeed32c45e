#include "ratio.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "plumb/plugin/step_testing.hpp"
#include "plumb/slam/step.hpp"
#include "shared/feature_space/feature_vectors_testing.hpp"

namespace plumb::match_fpfh_ratio {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::Pair;

/// Keypoints `spacing` [m] apart along x, with one number each.
Features numbered(std::vector<float> numbers, float spacing = 10) {
  Features f;
  f.dimension = 1;
  for (std::size_t k = 0; k < numbers.size(); ++k)
    f.points.push_back({spacing * static_cast<float>(k), 0, 0});
  f.vectors = std::move(numbers);
  return f;
}
RatioOptions options(double ratio, double min_separation, bool mutual) {
  RatioOptions result;
  result.ratio = ratio;
  result.min_separation = min_separation;
  result.mutual = mutual;
  return result;
}

TEST(RatioTest, KeepsWhatIsMuchNearerThanTheSecond) {
  // To 10: 11 is at 1 and 14 at 4, a quarter. To 20: 21 is at 1 and 19.5 at 0.5, a half.
  const Features a = numbered({10, 20}), b = numbered({11, 14, 21, 19.5f, 50});
  EXPECT_THAT(distinctive_pairs(a, b, options(0.26, 0, false)), ElementsAre(Pair(0, 0)));
  EXPECT_THAT(distinctive_pairs(a, b, options(0.24, 0, false)), IsEmpty());
  EXPECT_THAT(distinctive_pairs(a, b, options(0.51, 0, false)),
              ElementsAre(Pair(0, 0), Pair(1, 3)));
}

TEST(RatioTest, SeeksTheSecondAmongKeypointsThatStandApart) {
  // 21 lies 1 m beside 19.5, so they show one thing; the next is 50.
  const Features a = numbered({20}), b = numbered({19.5f, 21, 50}, 1);
  EXPECT_THAT(distinctive_pairs(a, b, options(0.1, 0, false)), IsEmpty());
  EXPECT_THAT(distinctive_pairs(a, b, options(0.1, 2, false)), ElementsAre(Pair(0, 0)));
  EXPECT_THAT(distinctive_pairs(a, b, options(0.1, 2.5, false)), IsEmpty()) << "nothing is apart";
}

TEST(RatioTest, HoldsBothWaysWhereThatIsAskedFor) {
  // 10 and 10.1 both find 11; 11 finds 10.1, hardly nearer than 10.
  const Features a = numbered({10, 10.1f, 90}), b = numbered({11, 70, 95});
  EXPECT_THAT(distinctive_pairs(a, b, options(0.5, 0, false)),
              ElementsAre(Pair(0, 0), Pair(1, 0), Pair(2, 2)));
  EXPECT_THAT(distinctive_pairs(a, b, options(0.5, 0, true)), ElementsAre(Pair(2, 2)));
  EXPECT_THAT(distinctive_pairs(a, b, options(0.95, 0, true)), ElementsAre(Pair(1, 0), Pair(2, 2)));
}

TEST(RatioTest, KeepsNoneOfEquals) {
  const Features a = numbered({10}), b = numbered({10, 10});
  EXPECT_THAT(distinctive_pairs(a, b, options(1, 0, false)), IsEmpty());
}

/// Straight from the definition, in double.
feature_space::Pairs judge(const Features& a, const Features& b, const RatioOptions& of) {
  const auto distance = [](const Features& f, std::size_t i, const Features& g, std::size_t k) {
    double sum = 0;
    for (std::size_t d = 0; d < f.dimension; ++d)
      sum += std::pow(static_cast<double>(f.vector(i)[d]) - static_cast<double>(g.vector(k)[d]), 2);
    return std::sqrt(sum);
  };
  const auto match = [&](const Features& f, std::size_t i, const Features& g) -> std::uint32_t {
    std::uint32_t first = 0;
    for (std::uint32_t k = 1; k < g.size(); ++k)
      if (distance(f, i, g, k) < distance(f, i, g, first)) first = k;
    double second = std::numeric_limits<double>::infinity();
    for (std::uint32_t k = 0; k < g.size(); ++k)
      if (k != first && (g.points[k] - g.points[first]).norm() >= of.min_separation)
        second = std::min(second, distance(f, i, g, k));
    return std::isfinite(second) && distance(f, i, g, first) < of.ratio * second
               ? first
               : static_cast<std::uint32_t>(g.size());
  };
  feature_space::Pairs pairs;
  for (std::uint32_t i = 0; i < a.size(); ++i)
    if (const auto j = match(a, i, b); j < b.size() && (!of.mutual || match(b, j, a) == i))
      pairs.emplace_back(i, j);
  return pairs;
}

TEST(RatioTest, IsWhatTheDefinitionSays) {
  const auto described = [](std::size_t count, std::uint64_t seed) {
    Features f;
    f.dimension = 33;
    f.vectors = feature_space::histograms(count, 33, seed);
    Random random(seed);
    for (std::size_t k = 0; k < count; ++k)
      f.points.push_back({static_cast<float>(30 * random.uniform()), 0, 0});
    return f;
  };
  const Features a = described(120, 1), b = described(150, 2);
  for (const bool mutual : {false, true})
    for (const double separation : {0.0, 2.5}) {
      const RatioOptions of = options(0.9, separation, mutual);
      const auto found = distinctive_pairs(a, b, of);
      EXPECT_EQ(found, judge(a, b, of));
      EXPECT_GT(found.size(), 0u);
      EXPECT_LT(found.size(), 120u);
    }
}

TEST(MatchFpfhRatioStep, PairsKeypointsByItsParameters) {
  TestContext context;
  StepUnderTest step(*plumb_module());
  step.over("edges").ends("features", numbered({10, 20}), numbered({11, 14, 21, 19.5f, 50}));
  const auto matches = step.set("ratio", 0.26)
                           .set("min_separation", 0.0)
                           .set("mutual", false)
                           .run<Matches>("matches", context);
  EXPECT_THAT(matches.index_p, ElementsAre(0));
  EXPECT_THAT(matches.index_q, ElementsAre(0));
  EXPECT_EQ(matches.found, 1u);
}

TEST(MatchFpfhRatioStep, MultipliesTheSeparationByTheScale) {
  TestContext context;
  StepUnderTest step(*plumb_module());
  step.over("edges").ends("features", numbered({20}), numbered({19.5f, 21, 50}, 1));
  step.set("ratio", 0.1).set("min_separation", 20.0).set("mutual", false);
  EXPECT_EQ(step.run<Matches>("matches", context).size(), 0u);
  step.with("scale", Metrics().add("scale", 0.1, ""));
  EXPECT_EQ(step.run<Matches>("matches", context).size(), 1u);
}

TEST(MatchFpfhRatioStep, FindsNothingWhereOneSideIsEmptyAndRefusesOtherLengths) {
  TestContext context;
  StepUnderTest step(*plumb_module());
  step.over("edges").ends("features", numbered({1}), Features());
  EXPECT_EQ(step.run<Matches>("matches", context).size(), 0u);
  Features other = numbered({1, 2});
  other.dimension = 2;
  other.points.resize(1);
  step.ends("features", numbered({1}), other);
  EXPECT_THROW(step.run<Matches>("matches", context), Error);
}

}  // namespace
}  // namespace plumb::match_fpfh_ratio
