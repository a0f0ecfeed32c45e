#include "collect.hpp"
#include "plumb/plugin/module.hpp"

namespace plumb {
namespace {

struct CollectRelations : WholeStep {
  struct In {
    Each<Registration> registrations;
  };
  struct Out {
    Relations relations;
  };
  struct Params {
    double inflate = 1;
  };

  static void describe(Declaration<CollectRelations>& is) {
    is.name("relations.collect").version(1).source("ours");
    is.summary("Makes relations for the pose graph of the registrations that are accepted.");
    is.input("registrations", &In::registrations, "how segments lie on each other, one per edge");
    is.output("relations", &Out::relations, "the accepted ones: relative pose and information");
    is.param("inflate", &Params::inflate)
        .range(1e-3, 1e3)
        .doc("the standard deviations that the registrations name are multiplied by it");
  }

  Out run(const In& in, const Params& params, Context& context) const {
    std::vector<Registration> registrations(in.registrations.size());
    context.parallel(registrations.size(),
                     [&](std::size_t k) { registrations[k] = *in.registrations.open(k); });
    Out out{collected(in.registrations.edges(), registrations, params.inflate)};
    context.count("registrations accepted", out.relations.relative.size());
    context.count("registrations not accepted and left out",
                  registrations.size() - out.relations.relative.size());
    return out;
  }
};

}  // namespace
}  // namespace plumb

PLUMB_MODULE(plumb::CollectRelations)
