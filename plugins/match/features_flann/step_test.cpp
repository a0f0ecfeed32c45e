#include "plumb/slam/step.hpp"

#include "plumb/plugin/step_testing.hpp"

namespace plumb::match_features_flann {
namespace {

/// Keypoints at x = 0, 1, 2, ... with one number each.
Features features(std::vector<float> numbers) {
  Features f;
  f.dimension = 1;
  for (std::size_t k = 0; k < numbers.size(); ++k)
    f.points.push_back({static_cast<float>(k), 0, 0});
  f.vectors = std::move(numbers);
  return f;
}

TEST(MatchFeaturesFlannStep, PairsPointsWithEachIndexAndSaysWhatItMissed) {
  for (const std::string index : {"exact_tree", "kmeans", "hierarchical"}) {
    TestContext context;
    const auto matches = StepUnderTest(*plumb_module())
                             .over("edges")
                             .ends("features", features({10, 20, 30}), features({31, 11, 12, 19}))
                             .set("index", index)
                             .run<Matches>("matches", context);
    EXPECT_EQ(matches.index_p, (std::vector<std::uint32_t>{0, 1, 2})) << index;
    EXPECT_EQ(matches.index_q, (std::vector<std::uint32_t>{1, 3, 0})) << index;
    EXPECT_EQ(matches.q[0], Eigen::Vector3f(1, 0, 0));
    EXPECT_EQ(context.counts["keypoints looked for exactly as well"], 3u);
    EXPECT_EQ(context.counts["of these found as near by the index"], 3u);
  }
}

TEST(MatchFeaturesFlannStep, FindsNothingWhereOneSideIsEmpty) {
  TestContext context;
  StepUnderTest step(*plumb_module());
  step.over("edges").ends("features", features({1}), Features());
  EXPECT_EQ(step.run<Matches>("matches", context).size(), 0u);
}

TEST(MatchFeaturesFlannStep, RefusesFeaturesOfDifferentLength) {
  Features other = features({1, 2});
  other.dimension = 2;
  other.points.resize(1);
  TestContext context;
  StepUnderTest step(*plumb_module());
  step.over("edges").ends("features", features({1}), other);
  EXPECT_THROW(step.run<Matches>("matches", context), Error);
}

}  // namespace
}  // namespace plumb::match_features_flann
