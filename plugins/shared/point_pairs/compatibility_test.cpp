#include "shared/point_pairs/compatibility.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <numeric>

#include "plumb/data/random.hpp"

namespace plumb::point_pairs {
namespace {

using testing::ElementsAre;

TEST(BitGraph, KnowsWhatIsJoinedBeyondAWord) {
  BitGraph graph(130);
  for (const auto& [a, b] : {std::pair{0, 1}, {0, 64}, {0, 129}, {1, 129}, {64, 65}})
    graph.join(static_cast<std::size_t>(a), static_cast<std::size_t>(b));
  EXPECT_TRUE(graph.joined(129, 0));
  EXPECT_TRUE(graph.joined(65, 64));
  EXPECT_FALSE(graph.joined(1, 64));
  EXPECT_EQ(graph.degree(0), 3u);
  EXPECT_EQ(graph.degree(2), 0u);
  EXPECT_EQ(graph.common(0, 1), 1u) << "129";
  EXPECT_EQ(graph.common(1, 64), 1u) << "0";
  std::vector<std::uint32_t> seen;
  for_each_bit(graph.row(0), [&](std::uint32_t k) { seen.push_back(k); });
  EXPECT_THAT(seen, ElementsAre(1, 64, 129));
}

TEST(Compatibility, IsWhatTheLengthsSay) {
  Random random(3);
  std::vector<Eigen::Vector3f> p, q;
  const auto uniform = [&] { return static_cast<float>(10 * random.uniform()); };
  for (int k = 0; k < 90; ++k) {
    const float a = uniform(), b = uniform(), c = uniform(), d = uniform();
    p.push_back({a, b, 0});
    q.push_back({c, d, 1});
  }
  std::vector<std::uint32_t> chosen;
  for (std::uint32_t k = 1; k < 90; k += 3) chosen.push_back(k);
  const BitGraph graph = compatibility_of(p, q, chosen, 1, 2);
  ASSERT_EQ(graph.size(), chosen.size());
  std::size_t joined = 0;
  for (std::size_t a = 0; a < chosen.size(); ++a)
    for (std::size_t b = 0; b < chosen.size(); ++b) {
      const Eigen::Vector3d of_p = (p[chosen[a]] - p[chosen[b]]).cast<double>(),
                            of_q = (q[chosen[a]] - q[chosen[b]]).cast<double>();
      const bool expected = a != b && std::abs(of_p.norm() - of_q.norm()) <= 1 &&
                            of_p.norm() >= 2 && of_q.norm() >= 2;
      EXPECT_EQ(graph.joined(a, b), expected) << a << " " << b;
      joined += expected;
    }
  EXPECT_GT(joined, 20u);
}

TEST(Compatibility, JoinsAllPairsOfARigidMotion) {
  std::vector<Eigen::Vector3f> p, q;
  for (int k = 0; k < 70; ++k) {
    const float f = static_cast<float>(k);
    p.push_back({f, 0.5f * f, std::sin(f)});
    q.push_back({7 - p.back().y(), p.back().x() + 2, p.back().z()});  // a quarter turn
  }
  std::vector<std::uint32_t> all(70);
  std::iota(all.begin(), all.end(), 0);
  const BitGraph graph = compatibility_of(p, q, all, 1e-3);
  for (std::size_t a = 0; a < 70; ++a) EXPECT_EQ(graph.degree(a), 69u);
}

}  // namespace
}  // namespace plumb::point_pairs
