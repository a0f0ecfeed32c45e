#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>

#include "loop_consistency.hpp"
#include "plumb/data/registration.hpp"
#include "plumb/plugin/module.hpp"

namespace plumb {
namespace {

const char* reason(LoopVerdict verdict) {
  switch (verdict) {
    case LoopVerdict::kept:
      return "kept";
    case LoopVerdict::against_odometry:
      return "rejected: no drift explains it";
    case LoopVerdict::against_loops:
      return "rejected: other loops of the place contradict it";
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
    Relations relations;
    Metrics metrics;
  };
  struct Params {
    double translation_per_metre = 0.01;
    double rotation_per_metre = 0.0005;
    double memory = 100;
    double max_deviation = 3.5;
    double min_agreement = 0.6;
    double neighbourhood = 150;
    double max_alone_position = 3;
    double translation_sigma = 0.1;
    double rotation_sigma = 0.003;
  };

  static void describe(Declaration<PruneLoopConsistency>& is) {
    is.name("prune.loop_consistency").version(1);
    is.summary(
        "Keeps the loops that agree with each other and with what the poses can have drifted.");
    is.source("[Mangelson2018] PCM; covariances that grow with the path are ours");
    is.input("registrations", &In::registrations,
             "how segments lie to each other, one per loop edge");
    is.input("poses", &In::poses, "where the segments are, drifted but locally good");
    is.scale(&In::scale);
    is.output("relations", &Out::relations, "the loops that are kept, with their information");
    is.output("metrics", &Out::metrics, "how many are kept, and each loop's reason");
    is.param("translation_per_metre", &Params::translation_per_metre)
        .unit("%")
        .range(1e-6, 10)
        .doc("drift of the poses: standard deviation of the translation, of the path");
    is.param("rotation_per_metre", &Params::rotation_per_metre)
        .unit("rad/m")
        .range(1e-8, 10)
        .doc("drift of the poses: standard deviation of the rotation for each metre of path");
    is.param("memory", &Params::memory)
        .unit("m")
        .range(0.1, 1e6)
        .doc("path over which drift goes on in the same direction; beyond it adds up at random");
    is.param("max_deviation", &Params::max_deviation)
        .range(0.1, 1000)
        .doc("standard deviations within which things agree");
    is.param("min_agreement", &Params::min_agreement)
        .unit("%")
        .range(0, 1)
        .doc("share of the neighbouring loops that must agree with a loop");
    is.param("neighbourhood", &Params::neighbourhood)
        .unit("m")
        .range(0, 1e6)
        .doc("loops with less path than this between them, at both ends, are compared");
    is.param("max_alone_position", &Params::max_alone_position)
        .unit("m")
        .range(0, 1e6)
        .doc(
            "a loop that no other confirms is kept where the drift's standard deviation is no more "
            "than this");
    is.param("translation_sigma", &Params::translation_sigma)
        .unit("m")
        .range(0, 1000)
        .doc(
            "deviation of a loop's translation on top of what its registration says: segments are "
            "not quite rigid");
    is.param("rotation_sigma", &Params::rotation_sigma)
        .unit("rad")
        .range(0, 10)
        .doc("the same of its rotation");
  }

  Out run(const In& in, const Params& params, Context& context) const {
    const auto& edges = in.registrations.edges().list;
    std::vector<Registration> registrations(in.registrations.size());
    context.parallel(registrations.size(),
                     [&](std::size_t k) { registrations[k] = *in.registrations.open(k); });
    std::vector<Loop> loops;
    std::vector<std::size_t> of;
    for (std::size_t k = 0; k < edges.size(); ++k) {
      if (edges[k].j >= in.poses->size())
        throw Error("a loop names segment " + std::to_string(edges[k].j) + ", but there are " +
                    std::to_string(in.poses->size()) + " poses: wire poses of the same segments");
      if (!registrations[k].accepted) continue;
      loops.push_back({edges[k].i, edges[k].j, registrations[k].T_i_j, params.translation_sigma,
                       params.rotation_sigma});
      of.push_back(k);
    }
    const auto verdicts =
        judge_loops(loops, *in.poses,
                    {{params.translation_per_metre, params.rotation_per_metre, params.memory},
                     params.max_deviation,
                     params.min_agreement,
                     params.neighbourhood,
                     params.max_alone_position});
    Out out;
    std::vector<std::string> fates(edges.size(), "not registered");
    std::size_t kept = 0, odometry = 0, contradicted = 0, alone = 0;
    for (std::size_t n = 0; n < loops.size(); ++n) {
      fates[of[n]] = reason(verdicts[n]);
      kept += verdicts[n] == LoopVerdict::kept,
          odometry += verdicts[n] == LoopVerdict::against_odometry;
      contradicted += verdicts[n] == LoopVerdict::against_loops,
          alone += verdicts[n] == LoopVerdict::alone;
      if (verdicts[n] == LoopVerdict::kept)
        out.relations.relative.push_back(relation_of(
            edges[of[n]], loops[n].T_i_j, widened(registrations[of[n]].information, params)));
    }
    out.metrics.add("loops_kept", static_cast<double>(kept), "")
        .add("loops_asked", static_cast<double>(edges.size()), "")
        .add("loops_registered", static_cast<double>(loops.size()), "")
        .add("loops_against_odometry", static_cast<double>(odometry), "")
        .add("loops_against_loops", static_cast<double>(contradicted), "")
        .add("loops_alone", static_cast<double>(alone), "");
    for (std::size_t k = 0; k < edges.size(); ++k) {
      const Registration& r = registrations[k];
      const Pose left = r.T_i_j.inverse() * in.poses->relative(edges[k].i, edges[k].j);
      out.metrics.edges.push_back(
          {edges[k].i, edges[k].j, edges[k].kind, r.pairs, fates[k] == "kept" ? r.pairs : 0,
           r.accepted ? left.translation.norm() : 0, fates[k] == "kept" ? 1.0 : 0.0, fates[k]});
    }
    context.count("loops kept", kept);
    context.count("loops dropped: no drift explains them", odometry);
    context.count("loops dropped: other loops contradict them", contradicted);
    context.count("loops dropped: alone and far", alone);
    return out;
  }

 private:
  /// The information after adding the step's own deviations to the registration's. Directions of
  /// which it knows nothing stay unknown.
  static Matrix6d widened(const Matrix6d& information, const Params& params) {
    if (information.isZero(0)) return Matrix6d::Zero();
    const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(information);
    const Vector6d values =
        eigen.eigenvalues().cwiseMax(1e-9 * std::max(eigen.eigenvalues().maxCoeff(), 1e-300));
    Matrix6d covariance = eigen.eigenvectors() * values.cwiseInverse().asDiagonal() *
                          eigen.eigenvectors().transpose();
    covariance.diagonal().head<3>().array() += std::pow(params.translation_sigma, 2);
    covariance.diagonal().tail<3>().array() += std::pow(params.rotation_sigma, 2);
    return covariance.ldlt().solve(Matrix6d::Identity());
  }
};

}  // namespace
}  // namespace plumb

PLUMB_MODULE(plumb::PruneLoopConsistency)
