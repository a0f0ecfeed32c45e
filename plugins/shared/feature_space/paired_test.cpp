#include "shared/feature_space/paired.hpp"

#include <gmock/gmock.h>

#include "plumb/data/error.hpp"

namespace plumb::feature_space {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

/// Keypoints at x = 0, 1, 2, ..., a number each.
Features keypoints(std::size_t count, std::vector<std::uint8_t> at_border) {
  Features f;
  f.dimension = 1;
  for (std::size_t k = 0; k < count; ++k) {
    f.points.push_back({static_cast<float>(k), 0, 0});
    f.normals.push_back({0, 0, 1});
    f.vectors.push_back(static_cast<float>(k));
  }
  f.at_border = std::move(at_border);
  return f;
}

TEST(Paired, TakesAllThatIsKnownOfThePoints) {
  const Matches m =
      paired(keypoints(3, {0, 1, 0}), keypoints(4, {0, 0, 0, 1}), {{0, 2}, {1, 0}, {2, 3}});
  EXPECT_EQ(m.found, 3u);
  EXPECT_EQ(m.p[1], Eigen::Vector3f(1, 0, 0));
  EXPECT_EQ(m.q[0], Eigen::Vector3f(2, 0, 0));
  EXPECT_THAT(m.index_p, ElementsAre(0, 1, 2));
  EXPECT_THAT(m.index_q, ElementsAre(2, 0, 3));
  EXPECT_THAT(m.at_border, ElementsAre(0, 1, 1));
  EXPECT_THAT(m.weight, ElementsAre(1, 1, 1));
  EXPECT_EQ(m.normal_p.size(), 3u);
}

TEST(Paired, HasNormalsOnlyWhereBothSidesHave) {
  Features bare = keypoints(2, {});
  bare.normals.clear();
  const Matches m = paired(keypoints(2, {}), bare, {{0, 0}});
  EXPECT_THAT(m.normal_p, IsEmpty());
  EXPECT_THAT(m.normal_q, IsEmpty());
  EXPECT_THAT(m.at_border, ElementsAre(0));
}

TEST(RequireOneDimension, NamesBoth) {
  Features other = keypoints(1, {});
  other.dimension = 352;
  EXPECT_NO_THROW(require_one_dimension(keypoints(1, {}), keypoints(2, {})));
  try {
    require_one_dimension(keypoints(1, {}), other);
    FAIL() << "was not refused";
  } catch (const Error& e) {
    EXPECT_THAT(e.what(), testing::HasSubstr("1 and 352 numbers"));
  }
}

}  // namespace
}  // namespace plumb::feature_space
