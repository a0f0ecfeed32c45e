#include "plumb/slam/step.hpp"

#include "join.hpp"
#include "plumb/plugin/module.hpp"

namespace plumb::edges_union {
namespace {

struct UnionOfEdges : WholeStep {
  struct In {
    Several<Edges> edges;
  };
  struct Out {
    Edges edges;
  };
  struct Params {};

  static void describe(Declaration<UnionOfEdges>& is) {
    is.name("edges.union").version(1).summary("Merges several lists of edges, each pair once.");
    is.source("[Tang2024] 2.4.1");
    is.input("edges", &In::edges, "lists of edges; the first that has a pair decides its kind");
    is.output("edges", &Out::edges, "all pairs, in order");
  }

  Out run(const In& in, const Params&, Context& context) const {
    std::vector<const Edges*> lists;
    std::size_t named = 0;
    for (const auto& [label, edges] : in.edges) {
      lists.push_back(&*edges);
      named += edges->size();
    }
    Edges all = joined(lists);
    context.count("edges named more than once", named - all.size());
    return {std::move(all)};
  }
};

}  // namespace
}  // namespace plumb::edges_union

PLUMB_MODULE(plumb::edges_union::UnionOfEdges)
