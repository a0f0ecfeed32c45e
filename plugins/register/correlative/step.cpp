#include "plumb/slam/step.hpp"

#include "correlative.hpp"
#include "plumb/plugin/module.hpp"
#include "plumb/slam/registration.hpp"
#include "plumb/slam/segment.hpp"

namespace plumb::register_correlative {
namespace {

struct RegisterCorrelative : EdgeStep {
  struct In {
    OverEdges edges;
    Ends<Segment> targets, sources;
    Relative poses;
  };
  struct Out {
    Registration registration;
  };
  struct Params {
    CorrelativeOptions search;
    double min_score = 0.3;
    std::string check() const {
      return search.fine_resolution > search.resolution
                 ? "fine_resolution must not be larger than resolution"
                 : "";
    }
  };

  static void describe(Declaration<RegisterCorrelative>& is) {
    is.name("register.correlative").version(1).source("[Olson2009], [Hess2016]");
    is.summary(
        "Registers planar clouds by exhaustive search of a window around the current pose "
        "(correlative scan matching).");
    is.input("edges", &In::edges, "pairs of segments to register");
    is.input("targets", &In::targets,
             "the target clouds, in the plane; that of an edge's i is used");
    is.input("sources", &In::sources, "the source clouds; that of an edge's j is used");
    is.input("poses", &In::poses, "the current poses of the segments: the centre of the window");
    is.output("registration", &Out::registration, "T_i_j, with its score as overlap");
    is.params(&Params::search);
    is.param("min_score", &Params::min_score).range(0, 1).doc("score of an accepted registration");
  }

  Out run(const In& in, const Params& params, Context& context) const {
    const CorrelativeResult found = correlate(in.targets.i->cloud, in.sources.j->cloud,
                                              planar::projected(in.poses.T_i_j), params.search);
    Registration out;
    out.T_i_j = in_space(found.T);
    out.iterations = found.retried ? 2 : 1;
    out.pairs = static_cast<std::uint32_t>(in.sources.j->cloud.size());
    out.overlap = static_cast<float>(found.score);
    out.accepted = found.score >= params.min_score;
    if (out.accepted) {
      // A cell's width as standard deviation.
      const double place = std::pow(params.search.fine_resolution, -2),
                   heading = std::pow(found.yaw_step, -2);
      out.information.diagonal() << place, place, 0, 0, 0, heading;
    }
    if (found.retried) context.count("searched again in all headings", 1);
    if (!out.accepted) context.count("registrations not accepted", 1);
    return {out};
  }
};

}  // namespace
}  // namespace plumb::register_correlative

PLUMB_MODULE(plumb::register_correlative::RegisterCorrelative)
