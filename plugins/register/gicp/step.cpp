#include "plumb/slam/step.hpp"

#include "gicp.hpp"
#include "plumb/plugin/module.hpp"

namespace plumb::register_gicp {
namespace {

struct RegisterGicp : EdgeStep {
  struct In {
    OverEdges edges;
    Ends<Segment> targets, sources;
    Relative poses;
    One<Registration> initial;
    One<Metrics> scale;
  };
  struct Out {
    Registration registration;
  };
  struct Params {
    GicpOptions gicp;
    pcl::FitOptions fit;
  };

  static void describe(Declaration<RegisterGicp>& is) {
    is.name("register.gicp")
        .version(1)
        .source("[Segal2009]; PCL, GeneralizedIterativeClosestPoint");
    is.summary("Registers clouds by GICP (generalized ICP, plane to plane).");
    is.input("edges", &In::edges, "pairs of segments to register");
    is.input("targets", &In::targets,
             "the target clouds, best with normals; that of an edge's i is used");
    is.input("sources", &In::sources, "the source clouds; that of an edge's j is used");
    is.input("poses", &In::poses, "the current poses of the segments: the initial guess");
    is.optional_input("initial", &In::initial, "the initial guess instead, if accepted");
    is.scale(&In::scale);
    is.output("registration", &Out::registration,
              "T_i_j, its information, iterations, MAE and overlap");
    is.params(&Params::gicp);
    is.params(&Params::fit);
  }

  Out run(const In& in, const Params& params, Context& context) const {
    const Segment &target = *in.targets.i, &source = *in.sources.j;
    const Pose start = in.initial && in.initial->accepted ? in.initial->T_i_j : in.poses.T_i_j;
    const auto found = gicp(target.cloud, source.cloud, start,
                            params.fit.max_correspondence_distance, params.gicp);
    const Registration registration = pcl::judged(target, source.cloud, found, start, params.fit);
    context.count("iterations", registration.iterations);
    if (!registration.accepted) context.count("registrations not accepted", 1);
    return {registration};
  }
};

}  // namespace
}  // namespace plumb::register_gicp

PLUMB_MODULE(plumb::register_gicp::RegisterGicp)
