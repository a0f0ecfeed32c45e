#include "plumb/slam/step.hpp"

#include "one_to_one.hpp"
#include "plumb/plugin/module.hpp"

namespace plumb::prune_one_to_one {
namespace {

struct OneToOne : EdgeStep {
  struct In {
    One<Matches> matches;
    Relative poses;
  };
  struct Out {
    Matches matches;
  };
  struct Params {};

  static void describe(Declaration<OneToOne>& is) {
    is.name("prune.one_to_one").version(1).source("PCL, CorrespondenceRejectorOneToOne");
    is.summary("Keeps of the pairs that share a point the one whose points lie closest.");
    is.input("matches", &In::matches, "the pairs to test, with the indices of their points");
    is.input("poses", &In::poses, "the current poses of the segments");
    is.output("matches", &Out::matches, "pairs no two of which have a point in common");
  }

  Out run(const In& in, const Params&, Context& context) const {
    const auto kept = one_to_one(*in.matches, in.poses.T_i_j);
    context.count("pairs dropped", in.matches->size() - kept.size());
    return {select(*in.matches, kept)};
  }
};

}  // namespace
}  // namespace plumb::prune_one_to_one

PLUMB_MODULE(plumb::prune_one_to_one::OneToOne)
