#pragma once
/// For tests of pipelines: steps that declare ports and parameters like the real ones and do
/// nothing.

#include <unistd.h>

#include <fstream>

#include "plumb/pipeline/reader.hpp"
#include "plumb/plugin/declaration.hpp"

namespace plumb::test {

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
    std::vector<Range> ranges;
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
    One<Range> ranges;
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

struct Overlap : WholeStep {
  struct In {
    Each<Segment> segments;
    One<Poses> poses;
  };
  struct Out {
    Edges edges;
  };
  struct Params {
    std::optional<double> threshold;
    double margin = 0.9;
  };
  static void describe(Declaration<Overlap>& is) {
    is.name("edges.overlap");
    is.input("segments", &In::segments, "")
        .input("poses", &In::poses, "")
        .output("edges", &Out::edges, "");
    is.param("threshold", &Params::threshold).unit("%").range(0, 1).doc("least overlap");
    is.param("margin", &Params::margin).range(0, 1).doc("share of the smallest");
  }
  Out run(const In&, const Params&, Context&) const { return {}; }
};

struct Union : WholeStep {
  struct In {
    Several<Edges> edges;
  };
  struct Out {
    Edges edges;
  };
  struct Params {};
  static void describe(Declaration<Union>& is) {
    is.name("edges.union");
    is.input("edges", &In::edges, "").output("edges", &Out::edges, "");
  }
  Out run(const In&, const Params&, Context&) const { return {}; }
};

struct Mutual : EdgeStep {
  struct In {
    OverEdges edges;
    Ends<Features> features;
  };
  struct Out {
    Matches matches;
  };
  struct Params {};
  static void describe(Declaration<Mutual>& is) {
    is.name("match.fpfh_mutual");
    is.input("edges", &In::edges, "")
        .input("features", &In::features, "")
        .output("matches", &Out::matches, "");
  }
  Out run(const In&, const Params&, Context&) const { return {}; }
};

struct PruneDistance : EdgeStep {
  struct In {
    One<Matches> matches;
    Relative poses;
    ThisEdge edges;
  };
  struct Out {
    Matches matches;
  };
  struct Params {
    double max = 2;
  };
  static void describe(Declaration<PruneDistance>& is) {
    is.name("prune.distance");
    is.input("matches", &In::matches, "")
        .input("poses", &In::poses, "")
        .optional_input("edges", &In::edges, "");
    is.output("matches", &Out::matches, "");
    is.param("max", &Params::max).unit("m").range(0, 1000).doc("farthest apart");
  }
  Out run(const In&, const Params&, Context&) const { return {}; }
};

struct PruneKmeans : EdgeStep {
  struct In {
    One<Matches> matches;
    Relative poses;
  };
  struct Out {
    Matches matches;
  };
  struct Params {
    int clusters = 3;
  };
  static void describe(Declaration<PruneKmeans>& is) {
    is.name("prune.kmeans");
    is.input("matches", &In::matches, "")
        .input("poses", &In::poses, "")
        .output("matches", &Out::matches, "");
    is.param("clusters", &Params::clusters).range(1, 20).doc("how many");
  }
  Out run(const In&, const Params&, Context&) const { return {}; }
};

struct PruneRansac : EdgeStep {
  struct In {
    One<Matches> matches;
  };
  struct Out {
    Matches matches;
  };
  struct Params {
    double inlier = 0.5;
    int iterations = 1000;
  };
  static void describe(Declaration<PruneRansac>& is) {
    is.name("prune.ransac");
    is.input("matches", &In::matches, "").output("matches", &Out::matches, "");
    is.param("inlier", &Params::inlier).unit("m").range(0, 100).doc("distance");
    is.param("iterations", &Params::iterations).range(1, 1e6).doc("tries");
  }
  Out run(const In&, const Params&, Context&) const { return {}; }
};

struct Solve : WholeStep {
  enum class Loss { none, huber, cauchy };
  struct In {
    One<Poses> poses;
    Each<Matches> matches;
  };
  struct Out {
    Poses poses;
    Metrics metrics;
  };
  struct Params {
    Loss loss = Loss::huber;
    double share = 0.1;
  };
  static void describe(Declaration<Solve>& is) {
    is.name("solve.pose_graph");
    is.input("poses", &In::poses, "").optional_input("matches", &In::matches, "");
    is.output("poses", &Out::poses, "").output("metrics", &Out::metrics, "");
    is.choice("loss", &Params::loss,
              {{"none", Loss::none, "squares"},
               {"huber", Loss::huber, "Huber"},
               {"cauchy", Loss::cauchy, "Cauchy"}})
        .doc("what outliers cost");
    is.param("share", &Params::share).unit("%").range(0, 1).doc("of something");
  }
  Out run(const In&, const Params&, Context&) const { return {}; }
};

struct Rmse : WholeStep {
  struct In {
    One<Edges> edges;
    Each<Segment> segments;
    Several<Poses> poses;
    One<Poses> pairs;
  };
  struct Out {
    Metrics metrics;
  };
  struct Params {
    double cap = 0.5;
  };
  static void describe(Declaration<Rmse>& is) {
    is.name("measure.match_rmse");
    is.input("edges", &In::edges, "")
        .input("segments", &In::segments, "")
        .input("poses", &In::poses, "")
        .optional_input("pairs", &In::pairs, "");
    is.output("metrics", &Out::metrics, "");
    is.param("cap", &Params::cap).unit("m").range(0, 100).doc("pairs farther apart do not count");
  }
  Out run(const In&, const Params&, Context&) const { return {}; }
};

struct WriteTrajectory : WholeStep {
  struct In {
    One<Trajectory> trajectory;
  };
  struct Out {
    Document document;
  };
  struct Params {
    std::string name = "trajectory.tum";
  };
  static void describe(Declaration<WriteTrajectory>& is) {
    is.name("write.trajectory");
    is.input("trajectory", &In::trajectory, "").output("document", &Out::document, "");
    is.param("name", &Params::name).doc("of the file");
  }
  Out run(const In&, const Params&, Context&) const { return {}; }
};

inline const Registry& registry() {
  static const StepOf<SequenceSource> source;
  static const StepOf<DistanceFilter> distance;
  static const StepOf<ByCount> by_count;
  static const StepOf<Merge> merge;
  static const StepOf<VoxelGrid> voxel;
  static const StepOf<Fpfh> fpfh;
  static const StepOf<Overlap> overlap;
  static const StepOf<Union> edges_union;
  static const StepOf<Mutual> mutual;
  static const StepOf<PruneDistance> prune_distance;
  static const StepOf<PruneKmeans> kmeans;
  static const StepOf<PruneRansac> ransac;
  static const StepOf<Solve> solve;
  static const StepOf<Rmse> rmse;
  static const StepOf<WriteTrajectory> write;
  static const Registry all = [] {
    Registry made;
    for (const Step* step : std::initializer_list<const Step*>{
             &source, &distance, &by_count, &merge, &voxel, &fpfh, &overlap, &edges_union, &mutual,
             &prune_distance, &kmeans, &ransac, &solve, &rmse, &write})
      made.add(*step);
    return made;
  }();
  return all;
}

/// A folder of its own for pipelines written in a test, removed afterwards.
class Folder {
 public:
  Folder() {
    static int number = 0;
    path_ = std::filesystem::temp_directory_path() /
            ("plumb_pipeline_" + std::to_string(getpid()) + "_" + std::to_string(number++));
    std::filesystem::create_directories(path_);
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  std::filesystem::path write(const std::string& name, const std::string& text) const {
    std::filesystem::create_directories((path_ / name).parent_path());
    std::ofstream(path_ / name, std::ios::binary) << text;
    return path_ / name;
  }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// A cascade of two stages with all that a pipeline may have.
inline const std::string cascade = R"(plumb: 1
name: cascade
about: a test
parameters:
  input: {type: path, about: the sequence}
  voxel: {type: length, default: 0.3 m, about: leaf}
steps:
  sequence: {use: source.sequence, with: {path: $input}}
  ranges:   {use: segment.by_count, from: sequence.trajectory, with: {frames: 30}}
  ranged:   {use: filter.distance, from: sequence.frames, with: {min: 1 m}}
  merged:   {use: segment.merge, from: {frames: ranged, ranges: ranges}}
  segments: {use: filter.voxel_grid, from: merged, with: {leaf: $voxel}}
  fpfh:     {use: describe.fpfh, from: segments}
  drift:
    steps:
      neighbours: {use: edges.overlap, from: {segments: segments, poses: ranges.poses}}
      matches:    {use: match.fpfh_mutual, from: {edges: neighbours, features: fpfh}}
      solved:     {use: solve.pose_graph, from: {poses: ranges, matches: matches}}
  edges: {use: edges.overlap, from: {segments: segments, poses: drift.solved}}
  coarse:
    repeat:
      passes:
        gate: [4 m, 2 m, 1 m]
      carry: {poses: solved}
      until: {all: [{metric: rmse, falls_by_less_than: 2 %}]}
      at_least: 2
      at_most: 6
      if_exhausted: warn
    start: {poses: drift.solved}
    steps:
      found:  {use: match.fpfh_mutual, from: {edges: edges, features: fpfh}}
      near:   {use: prune.distance, from: {matches: found, poses: poses}, with: {max: $gate}}
      kept:   {use: prune.kmeans, from: {matches: near, poses: poses}}
      solved: {use: solve.pose_graph, from: {matches: kept, poses: poses}, with: {loss: huber}}
      rmse:   {use: measure.match_rmse, from: {edges: edges, segments: segments, poses: solved}, with: {cap: 0.5 m}}
  written: {use: write.trajectory, from: sequence}
)";

}  // namespace plumb::test
