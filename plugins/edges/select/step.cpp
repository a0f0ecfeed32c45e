#include "plumb/slam/step.hpp"

#include "plumb/data/counted.hpp"
#include "plumb/plugin/module.hpp"
#include "select.hpp"

namespace plumb::edges_select {
namespace {

struct SelectEdges : WholeStep {
  struct In {
    One<Edges> edges;
    One<Poses> poses;
    One<Metrics> scale;
  };
  struct Out {
    Edges edges;
  };
  using Params = SelectOptions;

  static void describe(Declaration<SelectEdges>& is) {
    is.name("edges.select").version(1).source("ours");
    is.summary(
        "Keeps a few edges of each segment: some along the path, and the best ones to each other "
        "visit.");
    is.input("edges", &In::edges, "all edges; a higher score is better");
    is.input("poses", &In::poses, "poses of the segments, for the path between them");
    is.scale(&In::scale);
    is.output("edges", &Out::edges,
              "all sequential edges, and those that one of their ends selects");
    is.param("max_path_separation", &Params::max_path_separation)
        .unit("m")
        .range(0, 1e6)
        .doc(
            "edges between segments with more path between them are dropped, which removes "
            "revisits; none: no limit");
    is.param("max_along", &Params::max_along)
        .range(0, 20)
        .doc(
            "edges that a segment selects along the path, in each direction: to those 2, 3, 5, 8 "
            "... away");
    is.param("max_visits", &Params::max_visits)
        .range(0, 1000)
        .doc("other visits to its place that a segment selects");
    is.param("per_visit", &Params::per_visit)
        .range(1, 1000)
        .doc("edges to each of these visits, those with the greatest score");
  }

  Out run(const In& in, const Params& params, Context& context) const {
    if (in.edges->segments != in.poses->size())
      throw Error("the edges are of " + counted(in.edges->segments, "segments") + ", but got " +
                  counted(in.poses->size(), "poses") +
                  ": wire edges and poses of the same segments");
    std::vector<Eigen::Vector3d> positions;
    for (const Pose& pose : in.poses->T_world_segment) positions.push_back(pose.translation);
    Out out{select_edges(*in.edges, positions, params)};
    context.count("edges left out", in.edges->size() - out.edges.size());
    return out;
  }
};

}  // namespace
}  // namespace plumb::edges_select

PLUMB_MODULE(plumb::edges_select::SelectEdges)
