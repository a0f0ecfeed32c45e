/// Looks at trees and pairs of another module: a step a tree, a step a pair, one on all.
#include "forest.hpp"
#include "plumb/data/document.hpp"

namespace forest {
namespace {

struct Grow : TreeStep {
  struct In {
    plumb::One<Tree> tree;
  };
  struct Params {
    double by = 1;
  };
  struct Out {
    Tree tree;
  };
  static void describe(plumb::Declaration<Grow>& is) {
    is.name("forest.grow").version(1).summary("Lets each tree grow.").source("ours");
    is.input("tree", &In::tree, "a tree");
    is.output("tree", &Out::tree, "the same, higher");
    is.param("by", &Params::by).unit("m").range(0, 100).doc("how much");
  }
  Out run(const In& in, const Params& params, plumb::Context& context) const {
    context.count("trees grown", 1);
    return {{in.tree->place, in.tree->height + params.by}};
  }
};

struct Measure : PairStep {
  struct In {
    OverPairs pairs;
    plumb::Ends<Tree> trees;
  };
  struct Params {};
  struct Out {
    Gap gap;
  };
  static void describe(plumb::Declaration<Measure>& is) {
    is.name("forest.measure").version(1).summary("Measures between neighbours.").source("ours");
    is.input("pairs", &In::pairs, "which trees are neighbours");
    is.input("trees", &In::trees, "the two trees");
    is.output("gap", &Out::gap, "how far apart they stand");
  }
  Out run(const In& in, const Params&, plumb::Context&) const {
    return {{in.trees.j->place - in.trees.i->place}};
  }
};

struct Count : plumb::WholeStep {
  struct In {
    plumb::Each<Tree> trees;
    plumb::Each<Gap> gaps;
  };
  struct Params {};
  struct Out {
    Tally tally;
    plumb::Document document;
  };
  static void describe(plumb::Declaration<Count>& is) {
    is.name("forest.tally").version(1).summary("Adds up heights and gaps.").source("ours");
    is.input("trees", &In::trees, "trees").input("gaps", &In::gaps, "gaps");
    is.output("tally", &Out::tally, "their sums");
    is.output("document", &Out::document, "the same as text");
  }
  Out run(const In& in, const Params&, plumb::Context&) const {
    double height = 0, gap = 0;
    for (std::size_t k = 0; k < in.trees.size(); ++k) height += in.trees.open(k)->height;
    const Pairs& pairs = *in.gaps.list().as<Pairs>();
    for (std::size_t k = 0; k < in.gaps.size(); ++k) gap += in.gaps.open(k)->metres;
    Out out;
    out.tally.numbers = {{"height", height, "m"}, {"gap", gap, "m"}};
    out.document.name = "forest.txt";
    out.document.bytes.append(plumb::shortest(height) + " " + plumb::shortest(gap) + " " +
                              std::to_string(pairs.first.size()) + "\n");
    return out;
  }
};

}  // namespace
}  // namespace forest

PLUMB_MODULE(forest::Grow, forest::Measure, forest::Count)
