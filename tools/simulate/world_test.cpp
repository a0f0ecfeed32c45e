#include "simulate/world.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "simulate/random.hpp"
#include "simulate/testing.hpp"

namespace plumb::simulate {
namespace {

using Eigen::Vector3f;

Vector3f any_direction(Random& random) {
  return Vector3f(static_cast<float>(random.gauss()), static_cast<float>(random.gauss()),
                  0.3f * static_cast<float>(random.gauss()))
      .normalized();
}

/// Where a ray meets a triangle (Moeller and Trumbore), infinite if it does not.
float triangle(const Ray& ray, const Vector3f& a, const Vector3f& b, const Vector3f& c) {
  const Eigen::Vector3d e = (b - a).cast<double>(), f = (c - a).cast<double>();
  const Eigen::Vector3d d = ray.direction.cast<double>(), s = (ray.origin - a).cast<double>();
  const double det = e.dot(d.cross(f));
  const double u = s.dot(d.cross(f)) / det, v = d.dot(s.cross(e)) / det,
               t = f.dot(s.cross(e)) / det;
  const bool met = std::abs(det) > 1e-12 && u >= -1e-6 && v >= -1e-6 && u + v <= 1 + 1e-6 && t > 0;
  return met ? static_cast<float>(t) : std::numeric_limits<float>::infinity();
}

Hit meet(const Primitive& p, const Vector3f& from, const Vector3f& towards) {
  Hit hit;
  intersect(p, nullptr, {from, (towards - from).normalized()}, hit);
  return hit;
}

TEST(Primitive, MeetsABoxTurnedBy45DegreesAtItsCorner) {
  Primitive box;
  box.cosine = box.sine = std::sqrt(0.5f);
  box.centre = {10, 0, 0};
  EXPECT_NEAR(meet(box, {0, 0.001f, 0}, {10, 0.001f, 0}).t, 10 - std::sqrt(2.0f), 2e-3);
}

TEST(Primitive, MeetsACylinderAtItsWallAndAtItsLid) {
  Primitive pole;
  pole.kind = Primitive::Kind::cylinder;
  pole.centre = {50, 0, 1};
  pole.half = {0.1f, 0.1f, 1};
  const Hit wall = meet(pole, {0, 0, 1}, {50, 0, 1});
  EXPECT_NEAR(wall.t, 49.9, 1e-4);
  EXPECT_NEAR(wall.normal.x(), -1, 1e-4);
  EXPECT_NEAR(meet(pole, {50, 0, 5}, {50, 0, 0}).t, 3, 1e-5);
  EXPECT_TRUE(std::isinf(meet(pole, {0, 0.2f, 1}, {50, 0.2f, 1}).t));
}

TEST(Primitive, EveryHitOfAnEllipsoidSolvesItsEquation) {
  Primitive crown;
  crown.kind = Primitive::Kind::ellipsoid;
  crown.centre = {3, -2, 5};
  crown.half = {1, 1, 2};
  Random random(3);
  int hits = 0;
  for (int k = 0; k < 2000; ++k) {
    const Ray ray{Vector3f(-4, 1, 4),
                  (crown.centre + 2 * any_direction(random) - Vector3f(-4, 1, 4)).normalized()};
    Hit hit;
    if (!intersect(crown, nullptr, ray, hit)) continue;
    ++hits;
    EXPECT_NEAR((ray.at(hit.t) - crown.centre).cwiseQuotient(crown.half).norm(), 1, 1e-4);
    EXPECT_LT(hit.normal.dot(ray.direction), 0);
  }
  EXPECT_GT(hits, 100);
}

TEST(Primitive, OpeningsLieBehindTheWallNeverBeforeIt) {
  Primitive wall;
  wall.centre = {0, 20, 5};
  wall.half = {15, 5, 5};
  Facade facade;
  facade.seed = 7;
  Random random(4);
  int recessed = 0;
  for (int k = 0; k < 3000; ++k) {
    const Vector3f target(static_cast<float>(random.uniform(-14, 14)), 15,
                          static_cast<float>(random.uniform(0.1, 9.9)));
    const Ray ray{Vector3f(0, 0, 2), (target - Vector3f(0, 0, 2)).normalized()};
    Hit flat, deep;
    ASSERT_TRUE(intersect(wall, nullptr, ray, flat));
    ASSERT_TRUE(intersect(wall, &facade, ray, deep));
    const float depth = ray.at(deep.t).y() - 15;
    EXPECT_GE(depth, -1e-4f);
    EXPECT_LE(depth, 2.01f);
    EXPECT_LE(deep.normal.dot(ray.direction), 0);
    recessed += depth > 0.05f;
  }
  EXPECT_GT(recessed, 150);
  EXPECT_LT(recessed, 2000);
}

TEST(Ground, MeetsTheSameTriangleAsATestOfAllOfThem) {
  Random random(5);
  std::vector<float> heights(40 * 37);
  for (float& h : heights) h = static_cast<float>(random.uniform(-1, 1));
  const Ground ground({-20, -18}, 1, 40, 37, heights);
  int hits = 0;
  for (int k = 0; k < 400; ++k) {
    const Ray ray{Vector3f(static_cast<float>(random.uniform(-15, 15)),
                           static_cast<float>(random.uniform(-15, 15)), 2.5f),
                  any_direction(random)};
    float nearest = std::numeric_limits<float>::infinity();
    for (int j = 0; j + 1 < ground.rows(); ++j)
      for (int i = 0; i + 1 < ground.columns(); ++i) {
        const Vector3f low = ground.sample(i, j), high = ground.sample(i + 1, j + 1);
        nearest = std::min({nearest, triangle(ray, low, ground.sample(i + 1, j), high),
                            triangle(ray, low, high, ground.sample(i, j + 1))});
      }
    Hit hit;
    ground.intersect(ray, hit);
    if (std::isinf(nearest)) {
      EXPECT_TRUE(std::isinf(hit.t));
      continue;
    }
    ++hits;
    EXPECT_NEAR(hit.t, nearest, 2e-3f);
    EXPECT_NEAR(ground.height(ray.at(hit.t).x(), ray.at(hit.t).y()), ray.at(hit.t).z(), 2e-3f);
  }
  EXPECT_GT(hits, 100);
}

TEST(Ground, RunsTheSensorsHeightUnderThePathAndBetweenPassesThatDisagree) {
  std::vector<Vector3f> path;
  for (int k = 0; k < 200; ++k) path.emplace_back(k, 0, 0.03f * static_cast<float>(k));
  for (int k = 0; k < 200; ++k)
    path.emplace_back(199 - k, 1, 0.03f * static_cast<float>(199 - k) + 0.4f);
  const Ground ground = ground_under(path, 5, 50, 1);
  for (int k = 10; k < 190; k += 7)
    EXPECT_NEAR(ground.height(static_cast<float>(k), 0.5f), 0.03f * static_cast<float>(k) + 0.2f,
                0.06f);
}

TEST(World, TheTreeFindsWhatBruteForceFinds) {
  const Stage stage = set_up(small_scene("figure_eight", 30, 300));
  ASSERT_GT(stage.world.primitives().size(), 200u);
  Random random(6);
  for (int k = 0; k < 500; ++k) {
    Fan fan;
    const Pose& pose = stage.truth.T_world_frame[random.next() % stage.truth.size()];
    fan.origin = (pose.translation - stage.world.origin()).cast<float>();
    for (auto& direction : fan.directions) direction = any_direction(random);
    const Hits hits = stage.world.cast(fan, 120);
    for (std::size_t lane = 0; lane < lane_count; ++lane)
      ASSERT_EQ(hits[lane].t, stage.world.cast_by_brute_force(fan.ray(lane), 120).t);
  }
}

TEST(World, NoHouseOrCarStandsWhereThePathRuns) {
  for (const char* route : {"city_loop", "figure_eight", "out_and_back", "blocks"}) {
    const Stage stage = set_up(small_scene(route, 300, 600));
    for (const Pose& pose : stage.truth.T_world_frame) {
      const Vector3f at = (pose.translation - stage.world.origin()).cast<float>();
      for (const Primitive& p : stage.world.primitives()) {
        const Box box = bounds(p);
        if (p.kind != Primitive::Kind::box || box.low.z() > at.z() + 1) continue;
        const Vector3f d = at - p.centre;
        const float u = std::abs(p.cosine * d.x() + p.sine * d.y()) - p.half.x();
        const float v = std::abs(p.cosine * d.y() - p.sine * d.x()) - p.half.y();
        ASSERT_GT(std::max(u, v), 1.5f) << route;
      }
    }
  }
}

}  // namespace
}  // namespace plumb::simulate
