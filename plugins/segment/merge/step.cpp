#include "merge.hpp"
#include "plumb/plugin/module.hpp"

namespace plumb {
namespace {

struct Merge : SegmentStep {
  struct In {
    Each<Frame> frames;
    One<Range> ranges;
    One<Metrics> scale;
  };
  struct Out {
    Segment segment;
  };
  struct Params {
    double leaf = 0;
  };

  static void describe(Declaration<Merge>& is) {
    is.name("segment.merge").version(1).source("[Tang2024] 2.2");
    is.summary("Merges the frames of a segment by their poses into one rigid cloud.");
    is.input("frames", &In::frames, "the segment's own frames, in order");
    is.input("ranges", &In::ranges, "which frames they are, and where they stand in the segment");
    is.scale(&In::scale);
    is.output("segment", &Out::segment,
              "all their points in the segment's coordinates, or the means of those in each cell");
    is.param("leaf", &Params::leaf)
        .unit("m")
        .range(0, 1000)
        .doc(
            "edge length of cells to thin by while merging, as filter.voxel_grid does afterwards; "
            "0 keeps all points");
  }

  Out run(const In& in, const Params& params, Context& context) const {
    if (in.frames.size() != in.ranges->size())
      throw Error("the segment from frame " + std::to_string(in.ranges->first) + " has " +
                  std::to_string(in.ranges->size()) + " frames, but " +
                  std::to_string(in.frames.size()) +
                  " came in: wire frames and ranges of the same sequence");
    const auto open = [&](std::size_t k) { return in.frames.open(k).shared(); };
    std::size_t dropped = 0;
    Out out{params.leaf > 0 ? merge_thinned(*in.ranges, params.leaf, open, dropped)
                            : merge(*in.ranges, open)};
    if (dropped) context.count("points with a coordinate that is no number dropped", dropped);
    if (out.segment.cloud.empty()) context.count("segments without any point", 1);
    return out;
  }
};

}  // namespace
}  // namespace plumb

PLUMB_MODULE(plumb::Merge)
