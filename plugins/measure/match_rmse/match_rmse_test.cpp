#include "match_rmse.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "plumb/plugin/module.hpp"
#include "plumb/plugin/testing.hpp"
#include "plumb/slam/step.hpp"

extern "C" const PlumbModule* plumb_module();

namespace plumb::measure_match_rmse {
namespace {

Segment random_segment(std::uint64_t seed, int points) {
  Random random(seed);
  Cloud cloud;
  for (int k = 0; k < points; ++k) {
    const auto u = [&] { return static_cast<float>(10 * random.uniform()); };
    const float x = u(), y = u(), z = u();
    cloud.add({x, y, z});
  }
  return Segment().with(cloud, std::vector<std::uint16_t>(cloud.size(), 0));
}

TEST(NearestPairs, AreThoseOfBruteForce) {
  const auto i = random_segment(1, 300), j = random_segment(2, 300);
  const Pose T(exp_rotation({0.1, 0.2, 0.3}), {0.5, -1, 0.2});
  const auto pairs = nearest_pairs(i, j, T, 0.8, std::nullopt);
  IndexPairs expected;
  const Motion motion(T);
  for (std::uint32_t a = 0; a < 300; ++a) {
    float best = 0.8f * 0.8f;
    int nearest = -1;
    for (std::uint32_t b = 0; b < 300; ++b) {
      const float d = (motion * i.cloud.point(a) - j.cloud.point(b)).squaredNorm();
      if (d < best) best = d, nearest = static_cast<int>(b);
    }
    if (nearest >= 0) expected.emplace_back(a, nearest);
  }
  ASSERT_GT(expected.size(), 50u);
  EXPECT_EQ(pairs, expected);
}

TEST(NearestPairs, AskForEveryNthPointOnly) {
  const auto i = random_segment(1, 1000);
  EXPECT_EQ(nearest_pairs(i, i, Pose(), 1, 300).size(), 250u);  // every 4th
  EXPECT_EQ(nearest_pairs(i, i, Pose(), 1, 1000).size(), 1000u);
}

TEST(NearestPairs, AreNoneBetweenCloudsFarApartOrEmpty) {
  const auto i = random_segment(1, 10);
  const Pose far(Eigen::Quaterniond::Identity(), {100, 0, 0});
  EXPECT_TRUE(nearest_pairs(i, i, far, 1, std::nullopt).empty());
  EXPECT_TRUE(nearest_pairs(Segment(), i, Pose(), 1, std::nullopt).empty());
}

/// The step's metrics for a cloud compared with itself, the second copy shifted by 0, 1 and 2 cm
/// under three labels.
Metrics measured(bool fixed_pairs, const std::vector<std::string>& labels,
                 const ParameterValues& values = {}) {
  const auto cloud = random_segment(3, 500);
  const auto poses_with = [](double shift) {
    Poses poses;
    poses.T_world_segment = {Pose(),
                             Pose(Eigen::Quaterniond::Identity(), Eigen::Vector3d(shift, 0, 0))};
    return poses;
  };
  struct Held : Collection {
    std::vector<AnyValue> items;
    std::size_t size() const override { return items.size(); }
    AnyValue open(std::size_t k) const override { return items[k]; }
  };
  auto segments = std::make_shared<Held>();
  segments->items = {any_value(cloud), any_value(cloud)};
  Edges edges;
  edges.segments = 2;
  edges.list = {{0, 1, EdgeKind::sequential, 1, 0}};

  PortInput inputs[5];
  for (auto& input : inputs) input.wired = true;
  inputs[0].one = any_value(edges);
  inputs[1].each = segments;
  for (std::size_t k = 0; k < labels.size(); ++k)
    inputs[2].several.push_back({labels[k], any_value(poses_with(0.01 * static_cast<double>(k)))});
  inputs[3].wired = fixed_pairs;
  inputs[3].one = any_value(poses_with(0));
  const Step& step = *plumb_module()->steps[0];
  PortOutput output;
  TestContext context;
  step.run(step.parameters(values).get(), inputs, {&output, 1}, context);
  return *output.one.as<Metrics>();
}

TEST(MatchRmse, IsTheShiftWherePairsAreFoundOnce) {
  const auto metrics = measured(true, {"after", "middle", "before"});
  ASSERT_EQ(metrics.numbers.size(), 3u);
  EXPECT_EQ(metrics.numbers[1].name, "middle");
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(metrics.numbers[k].value, 0.01 * static_cast<double>(k), 1e-6);
    EXPECT_EQ(metrics.numbers[k].unit, "m");
  }
  ASSERT_EQ(metrics.edges.size(), 1u);
  EXPECT_EQ(metrics.edges[0].kept, 500u);
  EXPECT_NEAR(metrics.edges[0].residual, 0.02, 1e-6);
}

TEST(MatchRmse, IsCalledRmseWhereThereIsNoLabel) {
  const auto metrics = measured(false, {""});
  ASSERT_EQ(metrics.numbers.size(), 1u);
  EXPECT_EQ(metrics.numbers[0].name, "rmse");
  EXPECT_NEAR(metrics.numbers[0].value, 0, 1e-6);
}

TEST(MatchRmse, SaysHowManyEdgesHaveNoPairs) {
  const auto metrics = measured(false, {"a", "b"}, {{"max_correspondence_distance", 0.001}});
  EXPECT_THAT(metrics.notes, testing::ElementsAre(testing::HasSubstr("1 of 1 edges")));
  EXPECT_EQ(metrics.edges[0].status, "no matches");
  EXPECT_TRUE(std::isnan(metrics.numbers[1].value));
}

}  // namespace
}  // namespace plumb::measure_match_rmse
