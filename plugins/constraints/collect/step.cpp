#include "plumb/slam/step.hpp"

#include "collect.hpp"
#include "plumb/plugin/module.hpp"

namespace plumb::constraints_collect {
namespace {

struct CollectConstraints : WholeStep {
  struct In {
    Each<Registration> registrations;
  };
  struct Out {
    Constraints constraints;
  };
  struct Params {
    double inflate = 1;
  };

  static void describe(Declaration<CollectConstraints>& is) {
    is.name("constraints.collect").version(1).source("ours");
    is.summary("Converts the accepted registrations to constraints of the pose graph.");
    is.input("registrations", &In::registrations, "registrations of segments, one per edge");
    is.output("constraints", &Out::constraints, "the accepted ones: relative pose and information");
    is.param("inflate", &Params::inflate)
        .range(1e-3, 1e3)
        .doc("factor on the registrations' standard deviations");
  }

  Out run(const In& in, const Params& params, Context& context) const {
    const std::vector<Registration> registrations = in.registrations.all(context);
    Out out{collected(edges_of(in.registrations), registrations, params.inflate)};
    context.count("registrations accepted", out.constraints.relative.size());
    context.count("registrations not accepted and left out",
                  registrations.size() - out.constraints.relative.size());
    return out;
  }
};

}  // namespace
}  // namespace plumb::constraints_collect

PLUMB_MODULE(plumb::constraints_collect::CollectConstraints)
