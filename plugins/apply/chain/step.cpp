#include <algorithm>

#include "chain.hpp"
#include "plumb/data/registration.hpp"
#include "plumb/plugin/module.hpp"

namespace plumb {
namespace {

struct ApplyChain : WholeStep {
  struct In {
    One<Poses> poses;
    Each<Registration> registrations;
  };
  struct Out {
    Poses poses;
    Relations relations;
    Metrics metrics;
  };
  using Params = ChainOptions;

  static void describe(Declaration<ApplyChain>& is) {
    is.name("apply.chain").version(1).source("[Zhang2023] 2");
    is.summary("Composes the registrations of consecutive segments into a trajectory.");
    is.input("poses", &In::poses, "where the segments are before, as the odometry has it");
    is.input("registrations", &In::registrations,
             "how each segment of a chain lies on one before it");
    is.output(
        "poses", &Out::poses,
        "where the segments are now; those that no edge reaches lie between their neighbours");
    is.output("relations", &Out::relations, "the registrations, for solve.pose_graph");
    is.output("metrics", &Out::metrics,
              "how many registrations, their iterations, distances and overlap on average");
    is.param("weak_translation", &Params::weak_translation)
        .unit("m")
        .range(1e-4, 1000)
        .doc("standard deviation of a relation whose registration was not accepted");
    is.param("weak_rotation", &Params::weak_rotation)
        .unit("rad")
        .range(1e-5, 10)
        .doc("the same of its rotation");
  }

  Out run(const In& in, const Params& params, Context& context) const {
    std::vector<Registration> registrations(in.registrations.size());
    context.parallel(registrations.size(),
                     [&](std::size_t k) { registrations[k] = *in.registrations.open(k); });
    Chained chain = chained(*in.poses, in.registrations.edges(), registrations, params);

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
      context.count("segments without a registration, put between their neighbours",
                    chain.interpolated);
    if (chain.starts)
      context.count("places where the chain starts anew, after the initial motion", chain.starts);
    out.poses = std::move(chain.poses);
    out.relations = std::move(chain.relations);
    return out;
  }

 private:
  static Metrics metrics_of(const std::vector<Registration>& registrations) {
    double iterations = 0, mae = 0, overlap = 0;
    std::vector<float> distances;
    for (const Registration& r : registrations) {
      iterations += r.iterations;
      mae += static_cast<double>(r.mae);
      overlap += static_cast<double>(r.overlap);
      distances.push_back(r.mae);
    }
    const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
    if (!distances.empty()) std::nth_element(distances.begin(), middle, distances.end());
    const double n = std::max<double>(1, static_cast<double>(registrations.size()));
    return Metrics()
        .add("registrations", static_cast<double>(registrations.size()), "")
        .add("iterations", iterations / n, "")
        .add("mae", mae / n, "m")
        .add("mae_median", distances.empty() ? 0 : static_cast<double>(*middle), "m")
        .add("overlap", overlap / n, "");
  }
};

}  // namespace
}  // namespace plumb

PLUMB_MODULE(plumb::ApplyChain)
