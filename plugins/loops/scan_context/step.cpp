#include "plumb/slam/step.hpp"

#include "loops.hpp"
#include "plumb/data/counted.hpp"
#include "plumb/data/short_number.hpp"
#include "plumb/plugin/module.hpp"

namespace plumb::loops_scan_context {
namespace {

struct ScanContextLoops : WholeStep {
  struct In {
    Each<Segment> segments;
    One<Poses> poses;
    One<Metrics> scale;
  };
  struct Out {
    Edges edges;
  };
  struct Params {
    ContextOptions context;
    LoopOptions loops;
  };

  static void describe(Declaration<ScanContextLoops>& is) {
    is.name("loops.scan_context").version(1);
    is.summary("Proposes loop edges between segments whose scan contexts are similar.");
    is.source("[Kim2018]");
    is.input("segments", &In::segments, "the clouds");
    is.input("poses", &In::poses,
             "the current poses of the segments: what is up, and the path between two visits");
    is.scale(&In::scale);
    is.output("edges", &Out::edges, "loop edges; the score is the similarity");
    is.params(&Params::context);
    is.params(&Params::loops);
  }

  Out run(const In& in, const Params& params, Context& context) const {
    const std::size_t count = in.segments.size();
    if (in.poses->size() != count)
      throw Error("got " + counted(count, "segments") + " and " +
                  counted(in.poses->size(), "poses") + ": wire poses of the same segments");
    std::vector<Place> places(count);
    context.parallel(count, [&](std::size_t k) {
      const Pose& T_world_segment = in.poses->T_world_segment[k];
      const auto segment = in.segments.open(k);
      places[k].context = scan_context(segment->cloud, T_world_segment, params.context);
      places[k].position = T_world_segment.translation;
      places[k].centroid = T_world_segment * segment->centroid.cast<double>().eval();
    });
    Loops loops = find_loops(places, params.loops, context);
    if (loops.edges.list.empty())
      context.warn(
          "no loop found: no two segments with " + short_number(loops.min_path_separation) +
          " m of path between them are more similar than " + short_number(loops.threshold));
    context.count("loop edges", loops.edges.size());
    return {std::move(loops.edges)};
  }
};

}  // namespace
}  // namespace plumb::loops_scan_context

PLUMB_MODULE(plumb::loops_scan_context::ScanContextLoops)
