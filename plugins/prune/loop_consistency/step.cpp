#include "plumb/slam/step.hpp"

#include <cmath>

#include "loop_consistency.hpp"
#include "plumb/data/counted.hpp"
#include "plumb/plugin/module.hpp"
#include "plumb/slam/geometry/symmetric.hpp"
#include "plumb/slam/registration.hpp"

namespace plumb::prune_loop_consistency {
namespace {

const char* reason(LoopVerdict verdict) {
  switch (verdict) {
    case LoopVerdict::kept:
      return "accepted";
    case LoopVerdict::against_odometry:
      return "rejected: no drift explains it";
    case LoopVerdict::against_loops:
      return "rejected: other loops of the place contradict it";
    case LoopVerdict::undecided:
      return "undecided: loops of the place contradict each other in groups";
    case LoopVerdict::alone:
      return "rejected: no other loop confirms it";
  }
  return "?";
}

struct PruneLoopConsistency : WholeStep {
  struct In {
    Each<Registration> registrations;
    One<Poses> poses;
    One<Metrics> scale;
  };
  struct Out {
    Constraints constraints;
    Metrics metrics;
  };
  struct Params {
    double translation_per_metre = 0.01;
    double rotation_per_metre = 0.03 * deg;
    double correlation_length = 100;
    double max_deviation = 3.5;
    double min_agreement = 0.6;
    double max_rival_share = 0.5;
    double max_path_separation = 150;
    double max_unconfirmed_sigma = 3;
    double translation_sigma = 0.1;
    double rotation_sigma = 0.2 * deg;
  };

  static void describe(Declaration<PruneLoopConsistency>& is) {
    is.name("prune.loop_consistency").version(1);
    is.summary("Keeps the loops that are consistent with each other and with the expected drift.");
    is.source("[Mangelson2018] PCM; covariances that grow with the path are ours");
    is.input("registrations", &In::registrations, "registrations of segments, one per loop edge");
    is.input("poses", &In::poses, "poses of the segments, with drift but locally accurate");
    is.scale(&In::scale);
    is.output("constraints", &Out::constraints, "the kept loops, with their information");
    is.output("metrics", &Out::metrics, "number of loops kept, and each loop's reason");
    is.param("translation_per_metre", &Params::translation_per_metre)
        .unit("%")
        .range(1e-6, 10)
        .doc("drift: standard deviation of the translation, as a share of the path");
    is.param("rotation_per_metre", &Params::rotation_per_metre)
        .unit("rad/m")
        .range(1e-6 * deg, 360 * deg)
        .doc("drift: standard deviation of the rotation for each metre of path");
    is.param("correlation_length", &Params::correlation_length)
        .unit("m")
        .range(0.1, 1e6)
        .doc("path over which drift is correlated; beyond it adds up like a random walk");
    is.param("max_deviation", &Params::max_deviation)
        .range(0.1, 1000)
        .doc("standard deviations within which loops are consistent");
    is.param("min_agreement", &Params::min_agreement)
        .unit("%")
        .range(0, 1)
        .doc("share of the neighbouring loops that must be consistent with a loop");
    is.param("max_rival_share", &Params::max_rival_share)
        .unit("%")
        .range(0, 10)
        .doc(
            "rejected loops that contradict a kept one and agree with another, as a share of those "
            "that agree with it, above which neither side is kept");
    is.param("max_path_separation", &Params::max_path_separation)
        .unit("m")
        .range(0, 1e6)
        .doc("loops with less path than this between them, at both ends, are compared");
    is.param("max_unconfirmed_sigma", &Params::max_unconfirmed_sigma)
        .unit("m")
        .range(0, 1e6)
        .doc(
            "a loop without neighbours is kept where the drift's standard deviation is at most "
            "this");
    is.param("translation_sigma", &Params::translation_sigma)
        .unit("m")
        .range(0, 1000)
        .doc(
            "standard deviation of a loop's translation, in addition to that of its registration: "
            "segments are not quite rigid");
    is.param("rotation_sigma", &Params::rotation_sigma)
        .unit("rad")
        .range(0, 360 * deg)
        .doc("standard deviation of its rotation, likewise");
  }

  Out run(const In& in, const Params& params, Context& context) const {
    const auto& edges = edges_of(in.registrations).list;
    const std::vector<Registration> registrations = in.registrations.all(context);
    std::vector<Loop> loops;
    std::vector<std::size_t> of;
    for (std::size_t k = 0; k < edges.size(); ++k) {
      if (edges[k].j >= in.poses->size())
        throw Error("a loop names segment " + std::to_string(edges[k].j) + ", but got " +
                    counted(in.poses->size(), "poses") + ": wire poses of the same segments");
      if (!registrations[k].accepted) continue;
      loops.push_back({edges[k].i, edges[k].j, registrations[k].T_i_j, params.translation_sigma,
                       params.rotation_sigma});
      of.push_back(k);
    }
    const auto verdicts = judge_loops(
        loops, *in.poses,
        {{params.translation_per_metre, params.rotation_per_metre, params.correlation_length},
         params.max_deviation,
         params.min_agreement,
         params.max_rival_share,
         params.max_path_separation,
         params.max_unconfirmed_sigma});
    Out out;
    std::vector<std::string> statuses(edges.size(), "not registered");
    std::size_t kept = 0, odometry = 0, contradicted = 0, undecided = 0, alone = 0;
    for (std::size_t n = 0; n < loops.size(); ++n) {
      statuses[of[n]] = reason(verdicts[n]);
      kept += verdicts[n] == LoopVerdict::kept,
          odometry += verdicts[n] == LoopVerdict::against_odometry;
      contradicted += verdicts[n] == LoopVerdict::against_loops,
          undecided += verdicts[n] == LoopVerdict::undecided,
          alone += verdicts[n] == LoopVerdict::alone;
      if (verdicts[n] == LoopVerdict::kept)
        out.constraints.relative.push_back(constraint_of(
            edges[of[n]], loops[n].T_i_j, widened(registrations[of[n]].information, params)));
    }
    out.metrics.add("loops_kept", static_cast<double>(kept), "")
        .add("loops_asked", static_cast<double>(edges.size()), "")
        .add("loops_registered", static_cast<double>(loops.size()), "")
        .add("loops_against_odometry", static_cast<double>(odometry), "")
        .add("loops_against_loops", static_cast<double>(contradicted), "")
        .add("loops_undecided", static_cast<double>(undecided), "")
        .add("loops_alone", static_cast<double>(alone), "");
    for (std::size_t k = 0; k < edges.size(); ++k) {
      const Registration& r = registrations[k];
      const Pose left = r.T_i_j.inverse() * in.poses->relative(edges[k].i, edges[k].j);
      out.metrics.edges.push_back({edges[k].i, edges[k].j, edges[k].kind, r.pairs,
                                   statuses[k] == "accepted" ? r.pairs : 0,
                                   r.accepted ? left.translation.norm() : 0,
                                   statuses[k] == "accepted" ? 1.0 : 0.0, statuses[k]});
    }
    context.count("loops kept", kept);
    context.count("loops dropped: explained by no drift", odometry);
    context.count("loops dropped: contradicted by other loops", contradicted);
    context.count("loops dropped: undecided between groups of them", undecided);
    context.count("loops dropped: alone and far", alone);
    return out;
  }

 private:
  /// The information after adding the step's own deviations to the registration's. Directions of
  /// which it knows nothing stay unknown.
  static Matrix6d widened(const Matrix6d& information, const Params& params) {
    if (information.isZero(0)) return Matrix6d::Zero();
    const auto eigen = symmetric_eigen(information);
    const Vector6d values = eigen.values.cwiseMax(1e-9 * std::max(eigen.values.maxCoeff(), 1e-300));
    Matrix6d covariance =
        eigen.vectors * values.cwiseInverse().asDiagonal() * eigen.vectors.transpose();
    covariance.diagonal().head<3>().array() += std::pow(params.translation_sigma, 2);
    covariance.diagonal().tail<3>().array() += std::pow(params.rotation_sigma, 2);
    return inverse_of_symmetric(covariance);
  }
};

}  // namespace
}  // namespace plumb::prune_loop_consistency

PLUMB_MODULE(plumb::prune_loop_consistency::PruneLoopConsistency)
