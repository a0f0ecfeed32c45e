#include <gmock/gmock.h>

#include <random>

#include "shared/selection/evenly.hpp"
#include "shared/selection/median.hpp"

namespace plumb::selection {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

TEST(Evenly, TakesAllWhereThereAreNoMore) {
  EXPECT_THAT(evenly(3, 5), ElementsAre(0, 1, 2));
  EXPECT_THAT(evenly(3, 3), ElementsAre(0, 1, 2));
  EXPECT_THAT(evenly(0, 3), IsEmpty());
  EXPECT_THAT(evenly(3, 0), IsEmpty());
}

TEST(Evenly, SpacesThemByTheSameStepToWithinOne) {
  EXPECT_THAT(evenly(10, 4), ElementsAre(0, 2, 5, 7));
  for (const std::size_t count : {7, 100, 1001})
    for (const std::size_t most : {2, 3, 7}) {
      const auto chosen = evenly(count, most);
      ASSERT_EQ(chosen.size(), most);
      EXPECT_EQ(chosen.front(), 0u);
      for (std::size_t k = 0; k < most; ++k) {
        const std::size_t next = k + 1 < most ? chosen[k + 1] : count, step = next - chosen[k];
        EXPECT_GE(step, count / most);
        EXPECT_LE(step, count / most + 1);
      }
    }
}

TEST(Median, IsThatOfTheSortedValues) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-5, 5);
  for (const std::size_t count : {1, 2, 3, 10, 101}) {
    std::vector<double> values;
    for (std::size_t k = 0; k < count; ++k) values.push_back(uniform(random));
    const double found = median(values);
    std::ranges::sort(values);
    EXPECT_EQ(found, values[count / 2]);
  }
}

TEST(Median, OfNothingIsZero) { EXPECT_EQ(median({}), 0); }

}  // namespace
}  // namespace plumb::selection
