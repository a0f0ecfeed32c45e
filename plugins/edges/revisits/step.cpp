#include "plumb/plugin/module.hpp"
#include "revisits.hpp"

namespace plumb {
namespace {

struct RevisitEdges : WholeStep {
  struct In {
    One<Poses> poses;
  };
  struct Out {
    Edges edges;
  };
  using Params = RevisitOptions;

  static void describe(Declaration<RevisitEdges>& is) {
    is.name("edges.revisits").version(1).source("ours");
    is.summary("Joins every segment with the nearest one of each earlier visit to its place.");
    is.input("poses", &In::poses, "where the segments are at present");
    is.output("edges", &Out::edges, "neighbours; the score falls from 1 to 0 with the distance");
    is.param("distance", &Params::distance)
        .unit("m")
        .range(0.01, 1000)
        .doc("the farthest that two segments may lie apart");
    is.param("gap", &Params::gap)
        .unit("m")
        .range(0, 1e5)
        .doc("the least way that must lie between them");
    is.param("turn_length", &Params::turn_length)
        .unit("m")
        .range(0, 100)
        .doc("a turn of one rad counts as so much way");
  }

  Out run(const In& in, const Params& params, Context& context) const {
    Out out{revisits(*in.poses, params)};
    context.count("edges to earlier visits", out.edges.size());
    return out;
  }
};

}  // namespace
}  // namespace plumb

PLUMB_MODULE(plumb::RevisitEdges)
