#include "plumb/slam/step.hpp"

#include <memory>

#include "merge.hpp"
#include "plumb/data/counted.hpp"
#include "plumb/plugin/module.hpp"

namespace plumb::segment_merge {
namespace {

struct Merge : SegmentStep {
  struct In {
    Each<Frame> frames;
    One<FrameRange> ranges;
    One<Metrics> scale;
  };
  struct Out {
    Segment segment;
  };
  struct Params {
    double voxel_size = 0;
    bool middle_frame_only = false;
  };

  static void describe(Declaration<Merge>& is) {
    is.name("segment.merge").version(1).source("[Tang2024] 2.2");
    is.summary("Merges the frames of a segment into one rigid cloud.");
    is.input("frames", &In::frames, "the segment's own frames, in order");
    is.input("ranges", &In::ranges, "the frames of each segment, and their poses in it");
    is.scale(&In::scale);
    is.output("segment", &Out::segment,
              "all points in the segment's coordinates, or the means of the voxels");
    is.param("voxel_size", &Params::voxel_size)
        .unit("m")
        .range(0, 1000)
        .doc(
            "edge length of the voxels to downsample by while merging, as filter.voxel_grid does "
            "afterwards; 0 keeps all points");
    is.param("middle_frame_only", &Params::middle_frame_only)
        .doc("take the middle frame of each segment, whose coordinates are the segment's, alone")
        .source("[Zhang2023] 1: one scan a second");
  }

  Out run(const In& in, const Params& params, Context& context) const {
    if (in.frames.size() != in.ranges->size())
      throw Error("the segment from frame " + std::to_string(in.ranges->first) + " has " +
                  counted(in.ranges->size(), "frames") + ", but got " +
                  std::to_string(in.frames.size()) +
                  ": wire frames and ranges of the same sequence");
    const std::size_t middle = in.ranges->size() / 2;
    const auto open = [&](std::size_t k) -> std::shared_ptr<const Frame> {
      if (params.middle_frame_only && k != middle) return std::make_shared<const Frame>();
      return in.frames.open(k).shared();
    };
    std::size_t dropped = 0;
    Out out{params.voxel_size > 0 ? merge_thinned(*in.ranges, params.voxel_size, open, dropped)
                                  : merge(*in.ranges, open)};
    if (dropped) context.count("points with a non-finite coordinate dropped", dropped);
    if (out.segment.cloud.empty()) context.count("segments without any point", 1);
    return out;
  }
};

}  // namespace
}  // namespace plumb::segment_merge

PLUMB_MODULE(plumb::segment_merge::Merge)
