#include <gmock/gmock.h>

#include "plumb/data/error.hpp"
#include "plumb/data/random.hpp"
#include "plumb/plugin/testing.hpp"
#include "shared/overlapping/neighbours.hpp"

namespace plumb::overlapping {
namespace {

using testing::ElementsAre;

TEST(Meeting, FindsThePairsThatComparingEachWithEachFinds) {
  Random random(5);
  std::vector<Eigen::AlignedBox3d> boxes(120);
  for (auto& box : boxes) {
    const Eigen::Vector3d low(50 * random.uniform(), 50 * random.uniform(), 5 * random.uniform());
    box = {low, low + Eigen::Vector3d(10 * random.uniform(), 10 * random.uniform(), 2)};
  }
  boxes[17].setEmpty();
  std::vector<std::pair<std::uint32_t, std::uint32_t>> judge;
  for (std::uint32_t i = 0; i < 120; ++i)
    for (std::uint32_t j = i + 1; j < 120; ++j)
      if (i != 17 && j != 17 && (boxes[i].min().array() - 1 <= boxes[j].max().array()).all() &&
          (boxes[j].min().array() - 1 <= boxes[i].max().array()).all())
        judge.emplace_back(i, j);
  EXPECT_EQ(meeting(boxes, 1), judge);
  EXPECT_GT(judge.size(), 100u);
}

TEST(Lattice, BeginsAtAWholeMultipleAndHoldsAllWithCellsToSpare) {
  const Eigen::AlignedBox3d a(Eigen::Vector3d(3.2, -7.9, 0), Eigen::Vector3d(9, 1, 2)),
      b(Eigen::Vector3d(-20, 4, 1), Eigen::Vector3d(-18, 31.7, 3));
  const Lattice lattice = lattice_over({a, b}, 0.5);
  for (int c = 0; c < 3; ++c) {
    const double cells = lattice.origin[c] / 0.5;
    EXPECT_EQ(cells, std::floor(cells));
  }
  for (const auto& box : {a, b})
    for (const Eigen::Vector3d& corner : {box.min(), box.max()}) {
      const Eigen::Vector3d cell = (corner - lattice.origin) / 0.5;
      EXPECT_GE(cell.minCoeff(), 1);
      EXPECT_LT(cell.maxCoeff(), (1 << lattice.bits) - 1);
    }
  EXPECT_THROW(lattice_over({a, b}, 1e-5), Error);
}

TEST(Cells, AreThoseOfThePointInTheWorld) {
  const Pose T(exp_rotation({0.1, 0.2, 1.5}), {100, -50, 3});
  const Lattice lattice{0.25, {50, -75, -25}, 21};
  const Eigen::Vector3f point(4.3f, -2.1f, 0.7f);
  const Eigen::Vector3d world = T * point.cast<double>().eval();
  EXPECT_LT((Cells(T, lattice).of(point) - (world - lattice.origin) / 0.25).norm(), 1e-9);
  EXPECT_TRUE(Cells::within({0, 3, 7.99}, 3));
  EXPECT_FALSE(Cells::within({0, 3, 8}, 3));
  EXPECT_FALSE(Cells::within({-0.01, 3, 4}, 3));
}

/// Overlaps that are told, of ten segments at one place.
Neighbourhood told(const std::function<double(std::size_t, std::size_t)>& overlap,
                   const OverlapOptions& options) {
  Cloud cloud;
  cloud.add({0, 0, 0});
  cloud.add({1, 1, 1});
  const auto segment = std::make_shared<const Segment>(Segment().with(cloud, {0, 0}));
  Poses poses;
  poses.T_world_segment.resize(10);
  TestContext context;
  return neighbours(
      10, [&](std::size_t) { return segment; }, poses, options,
      {[](std::size_t, const Cloud&, const Pose&, const Lattice&) {},
       [&](std::size_t i, std::size_t j, double) { return overlap(i, j); }},
      context);
}

TEST(Neighbours, AreThoseAboveTheMarginOfTheSmallestOfConsecutiveOnes) {
  const auto overlap = [](std::size_t i, std::size_t j) {
    return j == i + 1 ? 0.5 + 0.01 * static_cast<double>(i) : i == 2 && j == 7 ? 0.46 : 0.44;
  };
  const auto found = told(overlap, {});
  EXPECT_DOUBLE_EQ(found.threshold, 0.45);
  ASSERT_EQ(found.edges.size(), 10u);
  EXPECT_EQ(found.compared, 36u);
  EXPECT_EQ(found.edges.list[3].i, 2u);
  EXPECT_EQ(found.edges.list[3].j, 7u);
  EXPECT_EQ(found.edges.list[3].kind, EdgeKind::neighbour);
  OverlapOptions given;
  given.threshold = 0.43;
  EXPECT_EQ(told(overlap, given).edges.size(), 45u);
}

TEST(Neighbours, AreNotAllWhereConsecutiveOnesDoNotOverlap) {
  const auto found = told(
      [](std::size_t i, std::size_t j) { return i == 4 && j == 5 ? 0.0
                                                : j == i + 1     ? 0.6
                                                                 : 0.04; },
      {});
  EXPECT_THAT(found.disconnected, ElementsAre(4));
  EXPECT_DOUBLE_EQ(found.threshold, 0.05) << "min_threshold";
  EXPECT_EQ(found.edges.size(), 9u);
}

}  // namespace
}  // namespace plumb::overlapping
