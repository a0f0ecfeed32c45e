#include "plumb/slam/step.hpp"

#include "plumb/plugin/step_testing.hpp"

namespace plumb::match_fpfh_mutual {
namespace {

/// Keypoints at x = 0, 1, 2, ... with one number each.
Features features(std::vector<float> numbers, std::vector<std::uint8_t> at_border) {
  Features f;
  f.dimension = 1;
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    f.points.push_back({static_cast<float>(k), 0, 0});
    f.normals.push_back({0, 0, 1});
  }
  f.vectors = std::move(numbers);
  f.at_border = std::move(at_border);
  return f;
}

TEST(MatchFpfhMutualStep, PairsPointsWithAllThatIsKnownOfThem) {
  TestContext context;
  const auto matches = StepUnderTest(*plumb_module())
                           .over("edges")
                           .ends("features", features({10, 20, 30}, {0, 1, 0}),
                                 features({31, 11, 12, 19}, {0, 0, 0, 0}))
                           .run<Matches>("matches", context);
  ASSERT_EQ(matches.size(), 3u);
  EXPECT_EQ(matches.found, 3u);
  EXPECT_EQ(matches.index_p, (std::vector<std::uint32_t>{0, 1, 2}));
  EXPECT_EQ(matches.index_q, (std::vector<std::uint32_t>{1, 3, 0}));
  EXPECT_EQ(matches.at_border, (std::vector<std::uint8_t>{0, 1, 0}));
  EXPECT_EQ(matches.weight, (std::vector<float>{1, 1, 1}));
  EXPECT_EQ(matches.p[2], Eigen::Vector3f(2, 0, 0));
  EXPECT_EQ(matches.q[0], Eigen::Vector3f(1, 0, 0));
  EXPECT_EQ(matches.normal_p.size(), 3u);
  EXPECT_EQ(matches.normal_q.size(), 3u);
}

TEST(MatchFpfhMutualStep, FindsNothingWhereOneSideIsEmpty) {
  TestContext context;
  StepUnderTest step(*plumb_module());
  step.over("edges").ends("features", features({1}, {0}), Features());
  EXPECT_EQ(step.run<Matches>("matches", context).size(), 0u);
}

TEST(MatchFpfhMutualStep, RefusesFeaturesOfDifferentLength) {
  Features other = features({1, 2}, {0});
  other.dimension = 2;
  other.points.resize(1);
  TestContext context;
  StepUnderTest step(*plumb_module());
  step.over("edges").ends("features", features({1}, {0}), other);
  EXPECT_THROW(step.run<Matches>("matches", context), Error);
}

}  // namespace
}  // namespace plumb::match_fpfh_mutual
