#include "plumb/slam/step.hpp"

#include "plumb/plugin/module.hpp"
#include "plumb/slam/registration.hpp"
#include "plumb/slam/segment.hpp"
#include "shared/planar/icp.hpp"

namespace plumb::register_icp {
namespace {

using planar::IcpOptions;
using planar::IcpResult;
using planar::Metric;
using planar::PlanarPose;
using planar::Stop;

struct RegisterParams {
  IcpOptions icp;
  double min_overlap = 0.5;
  std::string check() const {
    return icp.start_sigma && icp.metric == Metric::point ? "'start_sigma' goes with 'metric: line'"
                                                          : "";
  }
};

/// What both steps share: all but the rule for when to stop.
template <Stop stop>
struct Register : EdgeStep {
  struct In {
    OverEdges edges;
    Ends<Segment> targets, sources;
    Relative poses;
    One<Registration> initial;
  };
  struct Out {
    Registration registration;
  };
  using Params = RegisterParams;

  template <class Self>
  static void describe_shared(Declaration<Self>& is) {
    is.input("edges", &In::edges, "pairs of segments to register");
    is.input("targets", &In::targets,
             "the target clouds, in the plane; that of an edge's i is used");
    is.input("sources", &In::sources, "the source clouds; that of an edge's j is used");
    is.input("poses", &In::poses, "the current poses of the segments: the initial guess");
    is.optional_input("initial", &In::initial, "the initial guess instead, if accepted");
    is.output("registration", &Out::registration,
              "T_i_j, its information, iterations, MAE and overlap");
    is.params(&Params::icp,
              {"max_correspondence_distance", "metric", "max_iterations", "noise", "start_sigma"});
    is.param("min_overlap", &Params::min_overlap)
        .range(0, 1)
        .doc("share of the points that must have a pair for the registration to be accepted");
  }

  Out run(const In& in, const Params& params, Context& context) const {
    const Segment &target = *in.targets.i, &source = *in.sources.j;
    if (params.icp.metric == Metric::line && !target.cloud.empty() && !target.cloud.has_normals())
      throw Error(
          "'metric: line' needs normals and the targets have none: put estimate.normals with "
          "'planar: true' "
          "before, or use 'metric: point'");
    const PlanarPose start =
        planar::projected(in.initial && in.initial->accepted ? in.initial->T_i_j : in.poses.T_i_j);
    IcpOptions options = params.icp;
    options.stop = stop;
    Registration out;
    out.T_i_j = in_space(start);
    if (!target.cloud.empty() && !source.cloud.empty()) {
      const IcpResult found =
          planar::align(target.cloud, target.tree(), source.cloud, start, options);
      out.T_i_j = in_space(found.T);
      out.iterations = found.iterations, out.pairs = found.pairs;
      out.mae = static_cast<float>(found.mae), out.overlap = static_cast<float>(found.overlap);
      out.accepted = found.pairs >= 3 && found.overlap >= params.min_overlap;
      const int at[3] = {0, 1, 5};
      for (int r = 0; r < 3; ++r)
        for (int c = 0; c < 3; ++c) out.information(at[r], at[c]) = found.information(r, c);
    }
    context.count("iterations", out.iterations);
    if (!out.accepted) context.count("registrations not accepted", 1);
    return {out};
  }
};

struct RegisterIcp : Register<Stop::change> {
  static void describe(Declaration<RegisterIcp>& is) {
    is.name("register.icp").version(1).source("[Zhang2023] eq. (1)-(11)");
    is.summary(
        "Registers planar clouds by ICP (iterative closest points), until the pose converges.");
    describe_shared(is);
    is.params(&Params::icp, {"change"});
  }
};

struct RegisterIaIcp : Register<Stop::ratio> {
  static void describe(Declaration<RegisterIaIcp>& is) {
    is.name("register.ia_icp").version(1).source("[Zhang2023] 2, eq. (12)");
    is.summary(
        "Registers planar clouds by ICP (iterative closest points), until the mean distance of the "
        "pairs stops decreasing.");
    describe_shared(is);
    is.params(&Params::icp, {"ratio"});
  }
};

}  // namespace
}  // namespace plumb::register_icp

PLUMB_MODULE(plumb::register_icp::RegisterIcp, plumb::register_icp::RegisterIaIcp)
