#include "merge.hpp"

#include <gmock/gmock.h>

#include <limits>

#include "plumb/data/archive.hpp"
#include "plumb/plugin/context.hpp"
#include "plumb/plugin/step_testing.hpp"
#include "plumb/slam/step.hpp"
#include "shared/thinning/voxel_means.hpp"

namespace plumb::segment_merge {
namespace {

using testing::ElementsAre;

/// Random points round the sensor, with every array that a cloud can have.
Cloud scan(std::uint64_t seed, std::size_t n) {
  Random random(seed);
  const auto number = [&] { return static_cast<float>(100 * random.uniform() - 50); };
  Cloud cloud;
  for (std::size_t k = 0; k < n; ++k) {
    cloud.add({number(), number(), number()});
    const Eigen::Vector3f normal = Eigen::Vector3f(number(), number(), number()).normalized();
    cloud.nx.push_back(normal.x());
    cloud.ny.push_back(normal.y());
    cloud.nz.push_back(normal.z());
    cloud.intensity.push_back(number());
    cloud.time.push_back(number());
    cloud.ring.push_back(static_cast<std::uint16_t>(random.below(64)));
  }
  return cloud;
}

struct Merged {
  FrameRange range;
  std::vector<Frame> frames;
  std::vector<std::size_t> opened;

  explicit Merged(std::vector<Cloud> clouds) {
    range.first = 100;
    range.end = 100 + static_cast<std::uint32_t>(clouds.size());
    for (std::size_t k = 0; k < clouds.size(); ++k) {
      const double s = static_cast<double>(k);
      range.T_segment_frame.push_back({exp_rotation({0.3 * s, -0.1, 0.2}), {s, 10 * s, -1}});
      frames.push_back({100 + static_cast<std::uint32_t>(k), std::move(clouds[k])});
    }
  }
  Segment segment() {
    return merge(range, [&](std::size_t k) {
      opened.push_back(k);
      return std::make_shared<const Frame>(frames[k]);
    });
  }
};

TEST(SegmentMerge, MovesEveryPointByItsFramesPoseAndKeepsTheOrder) {
  Merged merged({scan(1, 50), scan(2, 30), scan(3, 70)});
  const Segment segment = merged.segment();
  ASSERT_EQ(segment.cloud.size(), 150u);
  ASSERT_EQ(segment.frame.size(), 150u);
  std::size_t at = 0;
  for (std::size_t f = 0; f < 3; ++f) {
    const Cloud& cloud = merged.frames[f].cloud;
    const Pose& pose = merged.range.T_segment_frame[f];
    for (std::size_t k = 0; k < cloud.size(); ++k, ++at) {
      EXPECT_EQ(segment.frame[at], f);
      EXPECT_LT(
          (segment.cloud.point(at) - (pose * cloud.point(k).cast<double>()).cast<float>()).norm(),
          3e-5);
      EXPECT_LT((segment.cloud.normal(at) -
                 (pose.rotation * cloud.normal(k).cast<double>()).cast<float>())
                    .norm(),
                1e-6);
      EXPECT_EQ(segment.cloud.intensity[at], cloud.intensity[k]);
      EXPECT_EQ(segment.cloud.time[at], cloud.time[k]);
      EXPECT_EQ(segment.cloud.ring[at], cloud.ring[k]);
    }
  }
}

TEST(SegmentMerge, ThinsWhileItMergesAsAVoxelGridDoesAfterwards) {
  for (const int lacking : {0, 1, 2}) {
    Merged merged({scan(1, 5000), Cloud(), scan(2, 3000), scan(3, 7000)});
    if (lacking == 1) merged.frames[2].cloud.intensity.clear();
    if (lacking == 2) merged.frames[3].cloud.nx.clear();
    merged.frames[2].cloud.y[7] = std::numeric_limits<float>::quiet_NaN();
    std::size_t dropped = 0;
    const Segment thinned = merge_thinned(
        merged.range, 9,
        [&](std::size_t k) { return std::make_shared<const Frame>(merged.frames[k]); }, dropped);
    const Segment whole = merged.segment();
    thinning::VoxelMeans means(9);
    means.add(whole.cloud, whole.frame, whole.range.origins());
    const auto expected = means.take();
    EXPECT_LT(thinned.cloud.size(), 10000u);
    EXPECT_EQ(content_hash(thinned.cloud), content_hash(expected.cloud));
    EXPECT_EQ(thinned.frame, expected.frame);
    EXPECT_EQ(dropped, 1u);
    EXPECT_EQ(expected.dropped, 1u);
    EXPECT_EQ(thinned.cloud.intensity.empty(), lacking == 1);
    EXPECT_EQ(thinned.cloud.has_normals(), lacking != 2);
    EXPECT_EQ(thinned.range.size(), 4u);
  }
}

TEST(SegmentMerge, OpensEachFrameOnceAndInOrder) {
  Merged merged({scan(1, 5), scan(2, 5), scan(3, 5)});
  merged.segment();
  EXPECT_THAT(merged.opened, ElementsAre(0, 1, 2));
}

TEST(SegmentMerge, DropsArraysThatSomeFrameLacks) {
  Merged merged({scan(1, 5), scan(2, 5), scan(3, 5)});
  merged.frames[1].cloud.intensity.clear();
  merged.frames[2].cloud.nx.clear();
  merged.frames[0].cloud.ring.clear();
  const Segment segment = merged.segment();
  EXPECT_EQ(segment.cloud.size(), 15u);
  EXPECT_TRUE(segment.cloud.intensity.empty());
  EXPECT_TRUE(segment.cloud.ring.empty());
  EXPECT_FALSE(segment.cloud.has_normals());
  EXPECT_TRUE(segment.cloud.nz.empty());
  EXPECT_EQ(segment.cloud.time.size(), 15u);
}

TEST(SegmentMerge, LosesNothingToAFrameWithoutPoints) {
  Merged merged({Cloud(), scan(2, 5), Cloud(), scan(3, 4)});
  const Segment segment = merged.segment();
  EXPECT_EQ(segment.cloud.intensity.size(), 9u);
  EXPECT_TRUE(segment.cloud.has_normals());
  EXPECT_THAT(segment.frame, ElementsAre(1, 1, 1, 1, 1, 3, 3, 3, 3));
}

TEST(SegmentMerge, KnowsItsRangeItsCentroidAndItsBox) {
  Merged merged({scan(1, 40), scan(2, 40)});
  const Segment segment = merged.segment();
  EXPECT_EQ(segment.range.first, 100u);
  EXPECT_EQ(segment.range.size(), 2u);
  EXPECT_LT((segment.centroid - centroid_of(segment.cloud)).norm(), 1e-6);
  EXPECT_EQ(segment.box.low, box_of(segment.cloud).low);
  EXPECT_EQ(segment.origin(79), merged.range.T_segment_frame[1].translation.cast<float>());
}

TEST(SegmentMergeStep, TakesTheMiddleFrameAloneWhenToldTo) {
  const Merged merged({scan(1, 40), scan(2, 30), scan(3, 20), scan(4, 10)});
  StepUnderTest step(*plumb_module());
  step.each("frames", merged.frames).with("ranges", merged.range);
  TestContext context;
  EXPECT_EQ(step.run<Segment>("segment", context).cloud.size(), 100u);
  step.set("middle_frame_only", true);
  const auto one = step.run<Segment>("segment", context);
  const Cloud& third =
      merged.frames[2].cloud;  // of four frames the one whose pose is the segment's
  ASSERT_EQ(one.cloud.size(), third.size());
  EXPECT_EQ(one.cloud.intensity, third.intensity);
  EXPECT_EQ(one.frame, std::vector<std::uint16_t>(third.size(), 2));
  EXPECT_EQ(one.range.size(), 4u);
  for (std::size_t k = 0; k < third.size(); ++k)
    EXPECT_LT(
        (one.cloud.point(k) - Motion(merged.range.T_segment_frame[2]) * third.point(k)).norm(),
        3e-5f);
  step.set("voxel_size", 1e-3);  // no two points share a voxel
  EXPECT_EQ(step.run<Segment>("segment", context).cloud.size(), third.size());
}

TEST(SegmentMerge, MakesAnEmptySegmentOfEmptyFrames) {
  Merged merged({Cloud(), Cloud()});
  const Segment segment = merged.segment();
  EXPECT_TRUE(segment.cloud.empty());
  EXPECT_TRUE(segment.box.empty());
}

}  // namespace
}  // namespace plumb::segment_merge
