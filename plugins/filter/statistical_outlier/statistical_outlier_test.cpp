#include "statistical_outlier.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "compact_groups.hpp"
#include "plumb/plugin/module.hpp"
#include "plumb/plugin/testing.hpp"
#include "plumb/slam/step.hpp"
#include "shared/parallel/loop_testing.hpp"
#include "sum_of_nearest.hpp"
#ifdef PLUMB_HAS_PCL
#include "pcl_twins.hpp"
#endif

extern "C" const PlumbModule* plumb_module();

namespace plumb::filter_statistical_outlier {
namespace {

using testing::Each;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

std::vector<float> means(const Cloud& cloud, std::size_t mean_k,
                         const parallel::Loop& loop = parallel::in_order) {
  return mean_distances(cloud, SearchTree(cloud), mean_k, loop);
}

/// A wall of points of uneven density, and some points in the air before it.
Cloud wall_with_birds(std::size_t on_wall, std::size_t birds) {
  Random random(5);
  Cloud cloud;
  for (std::size_t k = 0; k < on_wall; ++k) {
    const double u = random.uniform();
    cloud.add({static_cast<float>(20 * u * u), static_cast<float>(0.02 * random.uniform()),
               static_cast<float>(4 * random.uniform())});
  }
  for (std::size_t k = 0; k < birds; ++k)
    cloud.add({static_cast<float>(20 * random.uniform()),
               static_cast<float>(5 + 50 * random.uniform()),
               static_cast<float>(40 * random.uniform())});
  return cloud;
}

TEST(StatisticalOutlier, MeasuresTheMeanDistanceToItsNearestNeighbours) {
  Cloud cloud;
  for (const float x : {0.f, 1.f, 3.f, 7.f}) cloud.add({x, 0, 0});
  EXPECT_THAT(means(cloud, 2), ElementsAre(2, 1.5f, 2.5f, 5));
}

TEST(StatisticalOutlier, TakesTheNeighboursThatThereAre) {
  Cloud cloud;
  EXPECT_THAT(means(cloud, 20), IsEmpty());
  cloud.add({0, 0, 0});
  EXPECT_THAT(means(cloud, 20), ElementsAre(0));
  cloud.add({4, 0, 0});
  EXPECT_THAT(means(cloud, 20), ElementsAre(4, 4));
}

TEST(StatisticalOutlier, AgreesWithBruteForce) {
  const Cloud cloud = wall_with_birds(900, 30);
  const auto fast = means(cloud, 20);
  for (std::size_t k = 0; k < cloud.size(); ++k) {
    std::vector<float> distances;
    for (std::size_t i = 0; i < cloud.size(); ++i)
      if (i != k) distances.push_back((cloud.point(i) - cloud.point(k)).norm());
    std::sort(distances.begin(), distances.end());
    double sum = 0;
    for (int i = 0; i < 20; ++i) sum += distances[i];
    EXPECT_NEAR(fast[k], sum / 20, 1e-5 * sum);
  }
}

TEST(StatisticalOutlier, DoesNotDependOnTheOrderOfItsTasks) {
  const Cloud cloud = wall_with_birds(20000, 300);
  EXPECT_EQ(means(cloud, 20, parallel::backwards), means(cloud, 20));
}

TEST(CompactGroups, HoldEachPointOnceAndNearOnesTogether) {
  Cloud cloud;  // four heaps of 8, far apart, in mixed order
  for (int k = 0; k < 32; ++k)
    cloud.add({static_cast<float>(100 * (k % 2)), static_cast<float>(70 * (k / 2 % 2)),
               static_cast<float>(k % 5)});
  const auto order = compact_groups(cloud, 8);
  EXPECT_EQ(std::set<std::uint32_t>(order.begin(), order.end()).size(), 32u);
  for (std::size_t k = 0; k < 32; ++k)
    EXPECT_LT((cloud.point(order[k]) - cloud.point(order[k / 8 * 8])).norm(), 5);
  EXPECT_THAT(compact_groups(Cloud(), 8), IsEmpty());
}

TEST(SumOfNearest, AgreesWithSorting) {
  Random random(1);
  for (int round = 0; round < 2000; ++round) {
    const std::size_t n = 1 + random.below(200),
                      wanted = 1 + random.below(static_cast<std::uint32_t>(n));
    std::vector<float> squares(n);
    for (float& square : squares)  // in every third round many are equal
      square = round % 3 ? static_cast<float>(random.uniform() * random.uniform())
                         : 0.25f * static_cast<float>(random.below(4));
    auto sorted = squares;
    std::sort(sorted.begin(), sorted.end());
    double sum = 0;
    for (std::size_t k = 0; k < wanted; ++k) sum += std::sqrt(sorted[k]);
    EXPECT_NEAR(sum_of_nearest(squares.data(), n, wanted, sorted[wanted - 1]), sum, 1e-5 * sum);
    EXPECT_NEAR(sum_of_nearest(squares.data(), n, wanted, 7), sum, 1e-5 * sum);
  }
}

TEST(StatisticalOutlier, CountsEqualPointsAsNeighbours) {
  Cloud cloud;
  for (int k = 0; k < 50; ++k) cloud.add({1, 2, 3});
  EXPECT_THAT(means(cloud, 20), Each(0));
  EXPECT_THAT(not_beyond(means(cloud, 20), 2), SizeIs(50));
}

TEST(StatisticalOutlier, KeepsWhatIsNotBeyondMeanAndDeviations) {
  // Mean 2, standard deviation 2 (over n - 1).
  EXPECT_THAT(not_beyond({1, 1, 1, 5}, 1.4), ElementsAre(0, 1, 2));
  EXPECT_THAT(not_beyond({1, 1, 1, 5}, 1.6), ElementsAre(0, 1, 2, 3));
  EXPECT_THAT(not_beyond({}, 2), IsEmpty());
}

TEST(StatisticalOutlier, DropsTheBirdsAndCountsThem) {
  const Cloud cloud = wall_with_birds(5000, 20);
  Segment segment;
  segment.range.end = 1;
  segment.range.T_segment_frame = {Pose()};
  segment = segment.with(cloud, std::vector<std::uint16_t>(cloud.size(), 0));
  const Step& step = *plumb_module()->steps[0];
  PortInput input;
  input.wired = true;
  input.one = any_value(segment);
  PortOutput output;
  TestContext context;
  step.run(step.parameters({}).get(), {&input, 1}, {&output, 1}, context);
  const auto result = output.one.as<Segment>();
  EXPECT_LT(*std::max_element(result->cloud.y.begin(), result->cloud.y.end()), 5);
  EXPECT_GE(result->cloud.size(), 4990u);
  EXPECT_EQ(context.counts["outliers removed"], cloud.size() - result->cloud.size());
  EXPECT_EQ(result->frame.size(), result->cloud.size());
}

#ifdef PLUMB_HAS_PCL
TEST(StatisticalOutlier, KeepsThePointsThatPclKeeps) {
  const Cloud cloud = wall_with_birds(20000, 400);
  const auto theirs =
      twins::PclCloud(cloud.x, cloud.y, cloud.z, {}, {}, {}).without_outliers(20, 2);
  const auto ours = not_beyond(means(cloud, 20), 2);
  EXPECT_EQ(std::vector<int>(ours.begin(), ours.end()), theirs);
}
#endif

}  // namespace
}  // namespace plumb::filter_statistical_outlier
