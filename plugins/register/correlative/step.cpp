#include <numbers>

#include "correlative.hpp"
#include "plumb/data/registration.hpp"
#include "plumb/data/segment.hpp"
#include "plumb/plugin/module.hpp"

namespace plumb {
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
  struct Params : CorrelativeOptions {
    double least_score = 0.3;
    std::string check() const {
      return fine_resolution > resolution ? "fine_resolution must not be larger than resolution"
                                          : "";
    }
  };

  static void describe(Declaration<RegisterCorrelative>& is) {
    is.name("register.correlative").version(1).source("[Olson2009]");
    is.summary(
        "Lays planar clouds onto each other by trying every pose of a window round the present "
        "one.");
    is.input("edges", &In::edges, "which segments to lay onto each other");
    is.input("targets", &In::targets,
             "the clouds to lay onto, in the plane; of each edge that of i counts");
    is.input("sources", &In::sources, "the clouds that are laid; of each edge that of j counts");
    is.input("poses", &In::poses, "where the segments are at present: the middle of the window");
    is.output("registration", &Out::registration, "T_i_j and its score as overlap");
    const auto param = [&is](const char* name, double CorrelativeOptions::*member) {
      return is.param(name, static_cast<double Params::*>(member));
    };
    param("reach", &CorrelativeOptions::reach)
        .unit("m")
        .range(0.01, 20)
        .doc("half the window's width in x and y");
    param("turn", &CorrelativeOptions::turn)
        .unit("rad")
        .range(0.001, std::numbers::pi)
        .doc("half the window's width in heading");
    param("trust", &CorrelativeOptions::trust)
        .range(0, 1)
        .doc(
            "score that a pose far from the present one loses at most: where the points do not "
            "say, as along a corridor, the present "
            "pose does; a present pose that is the identity says nothing");
    param("trust_distance", &CorrelativeOptions::trust_distance)
        .unit("m")
        .range(1e-3, 10)
        .doc("so far off half of that is lost");
    param("trust_turn", &CorrelativeOptions::trust_turn)
        .unit("rad")
        .range(1e-3, std::numbers::pi)
        .doc("turned so far half of that is lost");
    param("resolution", &CorrelativeOptions::resolution)
        .unit("m")
        .range(0.01, 2)
        .doc("grid of the first search");
    param("sigma", &CorrelativeOptions::sigma)
        .unit("m")
        .range(0.005, 2)
        .doc("how far off a point may lie and still count, in the first search");
    param("retry_below", &CorrelativeOptions::retry_below)
        .range(0, 1)
        .doc("where the best score is lower the window is widened to retry_reach and all headings");
    param("retry_reach", &CorrelativeOptions::retry_reach)
        .unit("m")
        .range(0.01, 50)
        .doc("see retry_below");
    param("fine_resolution", &CorrelativeOptions::fine_resolution)
        .unit("m")
        .range(0.005, 1)
        .doc("grid of the second search, round the peak of the first");
    param("fine_sigma", &CorrelativeOptions::fine_sigma)
        .unit("m")
        .range(0.005, 1)
        .doc("how far off a point may lie and still count, in the second search");
    param("range", &CorrelativeOptions::range)
        .unit("m")
        .range(1, 1000)
        .doc("points farther from their sensor are left out");
    is.param("least_score", &Params::least_score)
        .range(0, 1)
        .doc("score that a registration must have to be accepted");
  }

  Out run(const In& in, const Params& params, Context& context) const {
    const CorrelativeResult found =
        correlate(in.targets.i->cloud, in.sources.j->cloud, planar(in.poses.T_i_j), params);
    Registration out;
    out.T_i_j = in_space(found.T);
    out.iterations = found.retried ? 2 : 1;
    out.pairs = static_cast<std::uint32_t>(in.sources.j->cloud.size());
    out.overlap = static_cast<float>(found.score);
    out.accepted = found.score >= params.least_score;
    if (out.accepted) {
      // A cell's width as standard deviation.
      const double place = std::pow(params.fine_resolution, -2),
                   heading = std::pow(found.yaw_step, -2);
      out.information.diagonal() << place, place, 0, 0, 0, heading;
    }
    if (found.retried) context.count("searched again in all headings", 1);
    if (!out.accepted) context.count("registrations not accepted", 1);
    return {out};
  }
};

}  // namespace
}  // namespace plumb

PLUMB_MODULE(plumb::RegisterCorrelative)
