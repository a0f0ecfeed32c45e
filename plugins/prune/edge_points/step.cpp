#include "plumb/slam/step.hpp"

#include "inner.hpp"
#include "plumb/plugin/module.hpp"

namespace plumb::prune_edge_points {
namespace {

struct EdgePoints : EdgeStep {
  struct In {
    One<Matches> matches;
  };
  struct Out {
    Matches matches;
  };
  struct Params {};

  static void describe(Declaration<EdgePoints>& is) {
    is.name("prune.edge_points").version(1);
    is.summary("Removes pairs with a point at the border of its cloud.");
    is.source("[Tang2024] 2.3.2, [Xiong2018]");
    is.input("matches", &In::matches, "pairs with border marks");
    is.output("matches", &Out::matches, "the pairs with both points inside");
  }

  Out run(const In& in, const Params&, Context& context) const {
    const auto kept = inner(*in.matches);
    context.count("pairs at a border dropped", in.matches->size() - kept.size());
    return {select(*in.matches, kept)};
  }
};

}  // namespace
}  // namespace plumb::prune_edge_points

PLUMB_MODULE(plumb::prune_edge_points::EdgePoints)
