#include "plumb/slam/step.hpp"

#include "plumb/plugin/module.hpp"
#include "proximity.hpp"

namespace plumb::loops_proximity {
namespace {

struct ProximityLoops : WholeStep {
  struct In {
    One<Poses> poses;
  };
  struct Out {
    Edges edges;
  };
  using Params = ProximityOptions;

  static void describe(Declaration<ProximityLoops>& is) {
    is.name("loops.proximity").version(1).source("ours");
    is.summary(
        "Proposes an edge from every segment to the nearest one of each earlier visit to its "
        "place.");
    is.input("poses", &In::poses, "the current poses of the segments");
    is.output("edges", &Out::edges, "neighbours; the score falls from 1 to 0 with the distance");
    is.param("max_distance", &Params::max_distance)
        .unit("m")
        .range(0.01, 1000)
        .doc("distance between two segments");
    is.param("min_path_separation", &Params::min_path_separation)
        .unit("m")
        .range(0, 1e5)
        .doc("path length between two segments");
    is.param("turn_length", &Params::turn_length)
        .unit("m")
        .range(0, 100)
        .doc("path length that a rotation by 1 rad counts as");
  }

  Out run(const In& in, const Params& params, Context& context) const {
    Out out{revisits(*in.poses, params)};
    context.count("edges to earlier visits", out.edges.size());
    return out;
  }
};

}  // namespace
}  // namespace plumb::loops_proximity

PLUMB_MODULE(plumb::loops_proximity::ProximityLoops)
