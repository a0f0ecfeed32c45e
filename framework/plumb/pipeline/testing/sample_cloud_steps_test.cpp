/// Of the steps that test_steps.hpp offers those that make frames, segments and what describes
/// them: they declare ports and parameters like the real ones and do nothing.
#include "plumb/pipeline/testing/test_steps.hpp"
#include "plumb/plugin/toy_testing.hpp"

namespace plumb::test {
namespace {

using namespace toy;

struct SequenceSource : WholeStep {
  struct In {};
  struct Out {
    Lazy<Frame> frames;
    Trajectory trajectory;
  };
  struct Params {
    std::filesystem::path path;
    std::optional<std::filesystem::path> trajectory;
  };
  static void describe(Declaration<SequenceSource>& is) {
    is.name("source.sequence");
    is.output("frames", &Out::frames, "").output("trajectory", &Out::trajectory, "");
    is.param("path", &Params::path).required().doc("the folder");
    is.param("trajectory", &Params::trajectory).doc("a TUM file");
  }
  Out run(const In&, const Params&, Context&) const { return {}; }
};

struct DistanceFilter : FrameStep {
  struct In {
    One<Frame> frame;
  };
  struct Out {
    Frame frame;
  };
  struct Params {
    double min = 0.5, max = 300;
  };
  static void describe(Declaration<DistanceFilter>& is) {
    is.name("filter.distance");
    is.input("frame", &In::frame, "").output("frame", &Out::frame, "");
    is.param("min", &Params::min).unit("m").range(0, 100).doc("nearest");
    is.param("max", &Params::max).unit("m").range(0, 1000).doc("farthest");
  }
  Out run(const In&, const Params&, Context&) const { return {}; }
};

struct ByCount : WholeStep {
  struct In {
    One<Trajectory> trajectory;
  };
  struct Out {
    std::vector<FrameRange> ranges;
    Poses poses;
  };
  struct Params {
    int frames = 60;
  };
  static void describe(Declaration<ByCount>& is) {
    is.name("segment.by_count");
    is.input("trajectory", &In::trajectory, "");
    is.output("ranges", &Out::ranges, "").output("poses", &Out::poses, "");
    is.param("frames", &Params::frames).range(1, 10000).doc("frames a segment");
  }
  Out run(const In&, const Params&, Context&) const { return {}; }
};

struct Merge : SegmentStep {
  struct In {
    Each<Frame> frames;
    One<FrameRange> ranges;
  };
  struct Out {
    Segment segment;
  };
  struct Params {};
  static void describe(Declaration<Merge>& is) {
    is.name("segment.merge");
    is.input("frames", &In::frames, "")
        .input("ranges", &In::ranges, "")
        .output("segment", &Out::segment, "");
  }
  Out run(const In&, const Params&, Context&) const { return {}; }
};

struct VoxelGrid : SegmentStep {
  struct In {
    One<Segment> segment;
  };
  struct Out {
    Segment segment;
  };
  struct Params {
    double leaf = 0.3;
    bool keep_normals = true;
  };
  static void describe(Declaration<VoxelGrid>& is) {
    is.name("filter.voxel_grid");
    is.input("segment", &In::segment, "").output("segment", &Out::segment, "");
    is.param("leaf", &Params::leaf).unit("m").range(0.01, 100).doc("edge length of a cell");
    is.param("keep_normals", &Params::keep_normals).doc("average them too");
  }
  Out run(const In&, const Params&, Context&) const { return {}; }
};

struct Fpfh : SegmentStep {
  struct In {
    One<Segment> segment;
  };
  struct Out {
    Features features;
  };
  struct Params {
    double radius = 2.5;
    double angle = 1;
  };
  static void describe(Declaration<Fpfh>& is) {
    is.name("describe.fpfh");
    is.input("segment", &In::segment, "").output("features", &Out::features, "");
    is.param("radius", &Params::radius).unit("m").range(0.1, 100).doc("of the neighbourhood");
    is.param("angle", &Params::angle).unit("rad").range(0, 4).doc("of a border");
  }
  Out run(const In&, const Params&, Context&) const { return {}; }
};

}  // namespace

void add_cloud_steps(Registry& registry) {
  static const StepOf<SequenceSource> source;
  static const StepOf<DistanceFilter> distance;
  static const StepOf<ByCount> by_count;
  static const StepOf<Merge> merge;
  static const StepOf<VoxelGrid> voxel;
  static const StepOf<Fpfh> fpfh;
  for (const Step* step :
       std::initializer_list<const Step*>{&source, &distance, &by_count, &merge, &voxel, &fpfh})
    registry.add(*step);
}

}  // namespace plumb::test
