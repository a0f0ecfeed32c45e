#include "plumb/slam/step.hpp"

#include "g2o_file.hpp"
#include "plumb/plugin/module.hpp"

namespace plumb::source_g2o {
namespace {

struct G2o : WholeStep {
  struct In {};
  struct Out {
    Constraints constraints;
    Poses poses;
  };
  struct Params {
    std::filesystem::path path;
  };

  static void describe(Declaration<G2o>& is) {
    is.name("source.g2o").version(1).source("[Kuemmerle2011]");
    is.summary("Reads a pose graph in the text format of g2o.");
    is.output("constraints", &Out::constraints,
              "the edges, with their information, and the fixed vertices");
    is.output("poses", &Out::poses, "the vertices, in order of their numbers");
    is.param("path", &Params::path)
        .required()
        .doc("file with VERTEX_SE3:QUAT and EDGE_SE3:QUAT, or VERTEX_SE2 and EDGE_SE2 lines");
  }

  Out run(const In&, const Params& params, Context&) const {
    G2oGraph graph = read_g2o(params.path);
    return {std::move(graph.constraints), std::move(graph.poses)};
  }
};

}  // namespace
}  // namespace plumb::source_g2o

PLUMB_MODULE(plumb::source_g2o::G2o)
