#include "plumb/slam/step.hpp"

#include "neighbours.hpp"
#include "plumb/data/counted.hpp"
#include "plumb/plugin/module.hpp"

namespace plumb::edges_overlap {
namespace {

struct OverlapEdges : WholeStep {
  struct In {
    Each<Segment> segments;
    One<Poses> poses;
    One<Metrics> scale;
  };
  struct Out {
    Edges edges;
  };
  using Params = OverlapOptions;

  static void describe(Declaration<OverlapEdges>& is) {
    is.name("edges.overlap").version(1);
    is.summary(
        "Proposes edges between segments whose clouds overlap, and between consecutive ones.");
    is.source("[Tang2024] 2.3.1");
    is.input("segments", &In::segments, "the clouds");
    is.input("poses", &In::poses, "the current poses of the segments");
    is.scale(&In::scale);
    is.output("edges", &Out::edges, "sequential edges, and neighbours; the score is the overlap");
    is.param("resolution", &Params::resolution)
        .unit("m")
        .range(0.01, 100)
        .doc("edge length of the octree's leaves: points in the same leaf overlap");
    is.param("threshold", &Params::threshold)
        .unit("%")
        .range(0, 1)
        .doc(
            "pairs that overlap more are neighbours; none: 'margin' x the smallest overlap of "
            "consecutive segments");
    is.param("margin", &Params::margin).unit("%").range(0.01, 1).doc("see 'threshold'");
    is.param("min_threshold", &Params::min_threshold)
        .unit("%")
        .range(0, 1)
        .doc("lower bound of the threshold, for consecutive segments that hardly overlap");
  }

  Out run(const In& in, const Params& params, Context& context) const {
    const std::size_t count = in.segments.size();
    if (count < 2)
      throw Error("got " + counted(count, "segments") +
                  ", so there is nothing to register: cut shorter segments "
                  "(segment.by_count: frames, "
                  "segment.by_distance: length)");
    require_pose_each(*in.poses, count);
    auto found = neighbours(
        count, [&](std::size_t k) { return in.segments.open(k).shared(); }, *in.poses, params,
        context);
    for (const auto k : found.disconnected)
      context.warn("segments " + std::to_string(k) + " and " + std::to_string(k + 1) +
                   " follow each other but do not overlap");
    context.count("pairs whose boxes meet", found.compared);
    context.count("neighbours", found.edges.size() - (count > 0 ? count - 1 : 0));
    return {std::move(found.edges)};
  }
};

}  // namespace
}  // namespace plumb::edges_overlap

PLUMB_MODULE(plumb::edges_overlap::OverlapEdges)
