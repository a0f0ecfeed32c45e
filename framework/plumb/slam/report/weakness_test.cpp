#include "plumb/slam/report/weakness.hpp"

#include <gmock/gmock.h>

#include "plumb/slam/types.hpp"

namespace plumb {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::SizeIs;
using testing::StartsWith;

/// A stage of ten segments in a row and one loop, with a note for each of the `weak` first edges.
MadeNumbers stage(const std::string& path, std::uint32_t weak) {
  Metrics metrics;
  for (std::uint32_t k = 0; k + 1 < 10; ++k) {
    metrics.edges.push_back(
        {k, k + 1, EdgeKind::sequential, 100, 90, 0.1, 1, k < weak ? "no matches" : "accepted"});
    if (k < weak) metrics.notes.push_back("segments " + std::to_string(k) + " are not joined");
  }
  metrics.edges.push_back({0, 9, EdgeKind::loop, 10, 10, 2, 0, "rejected"});
  return {path, any_value<Metrics>(metrics)};
}

TEST(Weakness, OfOneKindIsSaidAFewTimesAndCounted) {
  RunResult result;
  result.warnings = {"edges: segments 1 and 2 do not overlap"};
  result.numbers = {stage("drift", 4), stage("fine", 0), stage("last", 1)};
  EXPECT_THAT(weaknesses(result, true),
              ElementsAre("edges: segments 1 and 2 do not overlap",
                          "drift: segments 0 are not joined", "drift: segments 1 are not joined",
                          "drift: segments 2 are not joined (and 1 more like this)",
                          "last: segments 0 are not joined"));
  EXPECT_THAT(weaknesses(result, false), SizeIs(4));
}

TEST(Weakness, OfMostEdgesIsOneVerdictAndAFewSentences) {
  RunResult result;
  for (int k = 0; k < 14; ++k)
    result.warnings.push_back("edges: segments " + std::to_string(k) + " do not overlap");
  for (const char* path : {"a", "b", "c", "d", "e", "f"}) result.numbers.push_back(stage(path, 9));
  const auto lines = weaknesses(result, true);
  ASSERT_THAT(lines, SizeIs(6));
  EXPECT_THAT(lines[0], AllOf(StartsWith("most of the result is not held"), HasSubstr("54 of 54"),
                              HasSubstr("not in metres")));
  EXPECT_EQ(lines[1], "edges: segments 0 do not overlap (and 13 more like this)");
  EXPECT_EQ(lines[2], "a: segments 0 are not joined (and 8 more like this)");
  EXPECT_THAT(lines[5], HasSubstr("and 3 more sentences"));
}

TEST(Weakness, OfLoopsAloneIsNoVerdict) {
  RunResult result;
  Metrics metrics;
  for (std::uint32_t k = 0; k < 20; ++k)
    metrics.edges.push_back({0, k + 5, EdgeKind::loop, 9, 9, 1, 0, "rejected"});
  metrics.edges.push_back({0, 1, EdgeKind::sequential, 9, 9, 0.1, 1, "accepted"});
  result.numbers = {{"drift", any_value<Metrics>(metrics)}};
  EXPECT_THAT(weaknesses(result, true), SizeIs(0));
}

}  // namespace
}  // namespace plumb
