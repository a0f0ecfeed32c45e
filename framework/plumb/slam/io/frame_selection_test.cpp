#include "plumb/slam/io/frame_selection.hpp"

#include <gmock/gmock.h>

#include <algorithm>

#include "plumb/data/error.hpp"

namespace plumb::io {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::vector<std::size_t> kept(std::uint32_t skip, double drop, std::uint32_t seed,
                              std::size_t frames = 1000) {
  return FrameSelection{skip, drop, seed}.indices(frames, "run");
}

TEST(FrameSelection, TakesAllUnlessTold) {
  EXPECT_TRUE(FrameSelection().all());
  EXPECT_THAT(kept(0, 0, 7, 4), ElementsAre(0, 1, 2, 3));
  EXPECT_THAT(kept(2, 0, 0, 5), ElementsAre(2, 3, 4));
}

TEST(FrameSelection, DropsAboutTheShareAndOtherFramesForAnotherSeed) {
  for (const std::uint32_t seed : {1u, 2u, 3u}) {
    const auto left = kept(0, 0.1, seed, 10000);
    EXPECT_NEAR(static_cast<double>(left.size()), 9000, 120);  // four standard deviations
    EXPECT_TRUE(std::ranges::is_sorted(left));
    EXPECT_EQ(left, kept(0, 0.1, seed, 10000));
  }
  EXPECT_NE(kept(0, 0.1, 1), kept(0, 0.1, 2));
}

TEST(FrameSelection, DropsTheSameFramesAndMoreForALargerShare) {
  const auto few = kept(0, 0.3, 5), many = kept(0, 0.1, 5);
  EXPECT_TRUE(std::ranges::includes(many, few));
  EXPECT_LT(few.size(), many.size());
}

TEST(FrameSelection, DropsTheSameFramesWhereverItBegins) {
  auto whole = kept(0, 0.2, 9);
  std::erase_if(whole, [](std::size_t k) { return k < 40; });
  EXPECT_EQ(kept(40, 0.2, 9), whole);
}

TEST(FrameSelection, OfFewerThanTwoFramesIsRefused) {
  try {
    kept(9, 0, 0, 10);
    FAIL() << "not refused";
  } catch (const Error& e) {
    EXPECT_THAT(e.what(), AllOf(HasSubstr("run: has 10 frames"), HasSubstr("leave 1")));
  }
}

TEST(Selected, KeepsTheElementsInTheirOrder) {
  EXPECT_THAT(selected(std::vector<int>{5, 6, 7, 8}, {1, 3}), ElementsAre(6, 8));
  EXPECT_THAT(selected(std::vector<int>{5, 6}, {0, 1}), ElementsAre(5, 6));
}

}  // namespace
}  // namespace plumb::io
