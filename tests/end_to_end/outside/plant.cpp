/// Plants a row of trees: a module that defines types and kinds, and fills them.
#include "forest.hpp"

namespace forest {
namespace {

struct Plant : plumb::WholeStep {
  struct In {};
  struct Params {
    int trees = 4;
    double spacing = 2;
  };
  struct Out {
    std::vector<Tree> trees;
    Pairs neighbours;
  };
  static void describe(plumb::Declaration<Plant>& is) {
    is.name("forest.plant").version(1).summary("Plants a row of trees.").source("ours");
    is.output("trees", &Out::trees, "the trees, in their order along the row");
    is.output("neighbours", &Out::neighbours, "each tree and the next");
    is.param("trees", &Params::trees).range(1, 1000).doc("how many");
    is.param("spacing", &Params::spacing).unit("m").range(0.1, 100).doc("between two trees");
  }
  Out run(const In&, const Params& params, plumb::Context& context) const {
    Out out;
    out.neighbours.trees = static_cast<std::uint32_t>(params.trees);
    for (int k = 0; k < params.trees; ++k) {
      out.trees.push_back({k * params.spacing, 1.0 + k});
      if (k == 0) continue;
      out.neighbours.first.push_back(static_cast<std::uint32_t>(k - 1));
      out.neighbours.second.push_back(static_cast<std::uint32_t>(k));
    }
    context.count("trees planted", out.trees.size());
    return out;
  }
};

}  // namespace
}  // namespace forest

PLUMB_MODULE(forest::Plant)
