
#include "correlative.hpp"
#include "plumb/data/registration.hpp"
#include "plumb/data/segment.hpp"
#include "plumb/plugin/module.hpp"

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
  struct Params : CorrelativeOptions {
    double min_score = 0.3;
    std::string check() const {
      return fine_resolution > resolution ? "fine_resolution must not be larger than resolution"
                                          : "";
    }
  };

  static void describe(Declaration<RegisterCorrelative>& is) {
    is.name("register.correlative").version(1).source("[Olson2009]");
    is.summary(
        "Registers planar clouds by exhaustive search of a window around the current pose "
        "(correlative scan matching).");
    is.input("edges", &In::edges, "pairs of segments to register");
    is.input("targets", &In::targets,
             "the target clouds, in the plane; that of an edge's i is used");
    is.input("sources", &In::sources, "the source clouds; that of an edge's j is used");
    is.input("poses", &In::poses, "the current poses of the segments: the centre of the window");
    is.output("registration", &Out::registration, "T_i_j, with its score as overlap");
    const auto param = [&is](const char* name, double CorrelativeOptions::*member) {
      return is.param(name, static_cast<double Params::*>(member));
    };
    param("search_window", &CorrelativeOptions::search_window)
        .unit("m")
        .range(0.01, 20)
        .doc("half width of the window in x and y");
    param("search_angle", &CorrelativeOptions::search_angle)
        .unit("rad")
        .range(0.05 * deg, 180 * deg)
        .doc("half width of the window in heading");
    param("prior_weight", &CorrelativeOptions::prior_weight)
        .range(0, 1)
        .doc(
            "score that a pose far from the current one loses at most, so that the current pose "
            "decides where the points do not, as along a corridor; no effect where the current "
            "pose is the identity");
    param("prior_translation_sigma", &CorrelativeOptions::prior_translation_sigma)
        .unit("m")
        .range(1e-3, 10)
        .doc("translation at which half of it is lost");
    param("prior_rotation_sigma", &CorrelativeOptions::prior_rotation_sigma)
        .unit("rad")
        .range(0.05 * deg, 180 * deg)
        .doc("rotation at which half of it is lost");
    param("resolution", &CorrelativeOptions::resolution)
        .unit("m")
        .range(0.01, 2)
        .doc("edge length of a cell of the first search");
    param("sigma", &CorrelativeOptions::sigma)
        .unit("m")
        .range(0.005, 2)
        .doc("standard deviation of a point's position in the first search");
    param("retry_below", &CorrelativeOptions::retry_below)
        .range(0, 1)
        .doc(
            "where the best score is lower, the window is widened to retry_search_window and all "
            "headings");
    param("retry_search_window", &CorrelativeOptions::retry_search_window)
        .unit("m")
        .range(0.01, 50)
        .doc("see retry_below");
    param("fine_resolution", &CorrelativeOptions::fine_resolution)
        .unit("m")
        .range(0.005, 1)
        .doc("edge length of a cell of the second search, around the peak of the first");
    param("fine_sigma", &CorrelativeOptions::fine_sigma)
        .unit("m")
        .range(0.005, 1)
        .doc("standard deviation of a point's position in the second search");
    param("max_range", &CorrelativeOptions::max_range)
        .unit("m")
        .range(1, 1000)
        .doc("points farther from their sensor are left out");
    is.param("min_score", &Params::min_score).range(0, 1).doc("score of an accepted registration");
  }

  Out run(const In& in, const Params& params, Context& context) const {
    const CorrelativeResult found = correlate(in.targets.i->cloud, in.sources.j->cloud,
                                              planar::projected(in.poses.T_i_j), params);
    Registration out;
    out.T_i_j = in_space(found.T);
    out.iterations = found.retried ? 2 : 1;
    out.pairs = static_cast<std::uint32_t>(in.sources.j->cloud.size());
    out.overlap = static_cast<float>(found.score);
    out.accepted = found.score >= params.min_score;
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
}  // namespace plumb::register_correlative

PLUMB_MODULE(plumb::register_correlative::RegisterCorrelative)
