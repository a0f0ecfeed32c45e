#include "plumb/slam/step.hpp"

#include <algorithm>

#include "chain.hpp"
#include "plumb/plugin/module.hpp"
#include "plumb/slam/registration.hpp"
#include "shared/selection/median.hpp"

namespace plumb::apply_chain {
namespace {

struct ApplyChain : WholeStep {
  struct In {
    One<Poses> poses;
    Each<Registration> registrations;
  };
  struct Out {
    Poses poses;
    Constraints constraints;
    Metrics metrics;
  };
  using Params = ChainOptions;

  static void describe(Declaration<ApplyChain>& is) {
    is.name("apply.chain")
        .version(1)
        .source("[Zhang2023] 2; what stands for a registration that failed is ours");
    is.summary("Composes the registrations of consecutive segments into a trajectory.");
    is.input("poses", &In::poses, "poses of the segments from odometry");
    is.input("registrations", &In::registrations,
             "registration of each segment of a chain to an earlier one");
    is.output("poses", &Out::poses,
              "corrected poses of the segments; those without an edge are interpolated");
    is.output("constraints", &Out::constraints, "the registrations, for solve.pose_graph");
    is.output("metrics", &Out::metrics,
              "number of registrations; means of their iterations, distances and overlap");
    is.param("weak_translation_sigma", &Params::weak_translation_sigma)
        .unit("m")
        .range(1e-4, 1000)
        .doc(
            "standard deviation of the translation of a constraint whose registration was not "
            "accepted");
    is.param("weak_rotation_sigma", &Params::weak_rotation_sigma)
        .unit("rad")
        .range(0.001 * deg, 360 * deg)
        .doc("standard deviation of its rotation");
  }

  Out run(const In& in, const Params& params, Context& context) const {
    const std::vector<Registration> registrations = in.registrations.all(context);
    Chained chain = chained(*in.poses, edges_of(in.registrations), registrations, params);

    Out out;
    out.metrics = metrics_of(registrations);
    out.metrics.add("not_accepted", static_cast<double>(chain.replaced), "")
        .add("interpolated", static_cast<double>(chain.interpolated), "");
    if (chain.replaced) {
      context.count("registrations not accepted and replaced by the initial motion",
                    chain.replaced);
      context.warn(
          std::to_string(chain.replaced) + " of " + std::to_string(registrations.size()) +
          " registrations are not accepted: the initial motion stands there, with little weight");
    }
    if (chain.interpolated)
      context.count("segments without a registration, put between the neighbours",
                    chain.interpolated);
    if (chain.starts)
      context.count("places where the chain starts anew, after the initial motion", chain.starts);
    out.poses = std::move(chain.poses);
    out.constraints = std::move(chain.constraints);
    return out;
  }

 private:
  static Metrics metrics_of(const std::vector<Registration>& registrations) {
    double iterations = 0, mae = 0, overlap = 0;
    std::vector<double> distances;
    for (const Registration& r : registrations) {
      iterations += r.iterations;
      mae += static_cast<double>(r.mae);
      overlap += static_cast<double>(r.overlap);
      distances.push_back(static_cast<double>(r.mae));
    }
    const double n = std::max<double>(1, static_cast<double>(registrations.size()));
    return Metrics()
        .add("registrations", static_cast<double>(registrations.size()), "")
        .add("iterations", iterations / n, "")
        .add("mae", mae / n, "m")
        .add("mae_median", selection::median(std::move(distances)), "m")
        .add("overlap", overlap / n, "");
  }
};

}  // namespace
}  // namespace plumb::apply_chain

PLUMB_MODULE(plumb::apply_chain::ApplyChain)
