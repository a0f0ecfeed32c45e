#include "plumb/slam/step.hpp"

#include "graph_text.hpp"
#include "plumb/data/counted.hpp"
#include "plumb/data/document.hpp"
#include "plumb/plugin/module.hpp"

namespace plumb::write_graph {
namespace {

struct WriteGraph : WholeStep {
  struct In {
    One<Poses> poses;
    Each<Matches> matches;
    One<Constraints> constraints;
  };
  struct Out {
    Document document;
  };
  struct Params {
    std::string name = "graph.g2o";
    std::optional<double> noise;
    std::string check() const {
      return name.empty() || name.find('/') != std::string::npos
                 ? "name must be a file name without a folder, not '" + name + "'"
                 : "";
    }
  };

  static void describe(Declaration<WriteGraph>& is) {
    is.name("write.graph")
        .version(1)
        .summary("Writes the pose graph as a g2o file, for other solvers and viewers.");
    is.input("poses", &In::poses, "the vertices");
    is.optional_input("matches", &In::matches,
                      "point pairs: each edge becomes the relative pose that fits them best");
    is.optional_input("constraints", &In::constraints, "relative poses, written as they are");
    is.output("document", &Out::document, "the file");
    is.param("name", &Params::name).doc("name of the file in the output folder");
    is.param("noise", &Params::noise)
        .unit("m")
        .range(1e-6, 1000)
        .doc(
            "standard deviation of a pair, for the edges' information; none: the residual of each "
            "edge's fit");
  }

  Out run(const In& in, const Params& params, Context& context) const {
    Constraints graph;
    if (in.constraints) graph = *in.constraints;
    if (!graph.ids.empty() && graph.ids.size() != in.poses->size())
      throw Error("the constraints are of " + counted(graph.ids.size(), "poses") + ", but got " +
                  std::to_string(in.poses->size()) + "; wire poses of the same graph");
    if (in.matches) {
      const auto& edges = edges_of(in.matches).list;
      std::vector<std::optional<RelativePose>> found(edges.size());
      for (const auto& e : edges)
        if (e.i >= in.poses->size() || e.j >= in.poses->size())
          throw Error("an edge names a segment beyond the " + std::to_string(in.poses->size()) +
                      " poses; wire poses of the same segments");
      context.parallel(edges.size(), [&](std::size_t k) {
        found[k] = constraint_of(edges[k], *in.matches.open(k),
                                 in.poses->relative(edges[k].i, edges[k].j), params.noise);
      });
      std::uint64_t without = 0;
      for (auto& constraint : found)
        constraint ? graph.relative.push_back(*constraint) : void(++without);
      if (without) context.count("edges with fewer than 3 pairs not written", without);
    }
    return {{params.name, g2o_text(*in.poses, graph)}};
  }
};

}  // namespace
}  // namespace plumb::write_graph

PLUMB_MODULE(plumb::write_graph::WriteGraph)
