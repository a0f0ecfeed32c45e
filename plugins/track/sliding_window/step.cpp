#include "plumb/data/segment.hpp"
#include "plumb/plugin/module.hpp"
#include "track.hpp"

namespace plumb {
namespace {

struct TrackSlidingWindow : WholeStep {
  struct In {
    Each<Segment> segments;
    One<Poses> poses;
    One<Edges> edges;
  };
  struct Out {
    Poses poses;
    Metrics metrics;
  };
  struct Params {
    std::uint32_t frames = 10;
    double every = 0.25, turn = 0.26;
    std::optional<double> leaf = 0.05;
    double radius = 0.25;
    Stop stop = Stop::ratio;
    Metric metric = Metric::line;
    double reach = 0.3;
    std::uint32_t iterations = 50;
    double change = 1e-4, ratio = 0.95;
    std::optional<double> hold;
    double least_overlap = 0.5;
    std::optional<double> search_below = 0.9;
    double search_blind = 0.98;
    double search_reach = 0.6, search_turn = 0.5, lost_reach = 1.5;
    std::uint32_t patience = 5;
    std::string check() const {
      return hold && metric == Metric::point ? "'hold' goes with 'metric: line'" : "";
    }
  };

  static void describe(Declaration<TrackSlidingWindow>& is) {
    is.name("track.sliding_window").version(1).source("[Zhang2023] 2");
    is.summary(
        "Follows a 2-D laser: lays each scan in turn onto the stitched group of those before it.");
    is.input("segments", &In::segments, "the scans in order, one a segment, in the plane");
    is.input("poses", &In::poses,
             "where they are as the odometry has it; all the same where there is none");
    is.input("edges", &In::edges,
             "the chain of accepted scans; an edge that is not sequential starts the window again");
    is.output("poses", &Out::poses,
              "where the scans are now; those outside the chain lie between their neighbours");
    is.output("metrics", &Out::metrics,
              "scans laid on, iterations, distances and overlap on average; windows started again");
    is.param("frames", &Params::frames)
        .range(1, 1000)
        .doc("scans in the window")
        .source("[Zhang2023] 2");
    is.param("every", &Params::every)
        .unit("m")
        .range(0, 100)
        .doc(
            "a scan joins the window when it is farther than this from the window's newest; 0: "
            "each does");
    is.param("turn", &Params::turn).unit("rad").range(0, 7).doc("or turned by more");
    is.param("leaf", &Params::leaf)
        .unit("m")
        .range(0.001, 10)
        .doc(
            "points of the group so near to one that is kept become one with it, their mean; none: "
            "every point stays");
    is.param("radius", &Params::radius)
        .unit("m")
        .range(0.01, 10)
        .doc("of the neighbourhood that a point's normal is taken from");
    is.choice("stop", &Params::stop,
              {{"ratio", Stop::ratio,
                "when the mean distance of the pairs stops falling: IA-ICP, eq. (12)"},
               {"change", Stop::change, "when the pose rests: the usual ICP"}})
        .doc("when a registration ends")
        .source("[Zhang2023] eq. (12)");
    is.choice("metric", &Params::metric,
              {{"line", Metric::line, "the part of the pairs' distance along the group's normal"},
               {"point", Metric::point, "the distance of the pairs"}})
        .doc("what is made small")
        .source("[Zhang2023] eq. (3)");
    is.param("reach", &Params::reach)
        .unit("m")
        .range(1e-3, 100)
        .doc("farthest that a pair may be apart");
    is.param("iterations", &Params::iterations).range(1, 10000).doc("the most iterations");
    is.param("change", &Params::change)
        .range(1e-9, 1)
        .doc("it rests when it moves by less, m and rad together");
    is.param("ratio", &Params::ratio)
        .range(0, 1)
        .doc("stops when the mean distance is no less than this times that of the iteration before")
        .source("[Zhang2023] 2");
    is.param("hold", &Params::hold)
        .unit("m")
        .range(1e-4, 100)
        .doc(
            "with metric line, standard deviation of the odometry from scan to scan, a third of it "
            "in rad for the heading; none: free");
    is.param("least_overlap", &Params::least_overlap)
        .range(0, 1)
        .doc(
            "share of a scan's points that must have a partner; else the expected motion stands "
            "and the scan stays outside the window");
    is.param("search_below", &Params::search_below)
        .range(0, 1)
        .doc("where the overlap is less, every pose round the expected one is tried; none: never");
    is.param("search_blind", &Params::search_blind)
        .range(0, 1)
        .doc("the same where there is no odometry, if it is more");
    is.param("search_reach", &Params::search_reach)
        .unit("m")
        .range(0.01, 20)
        .doc("half the width of that search");
    is.param("search_turn", &Params::search_turn)
        .unit("rad")
        .range(0.001, 3.15)
        .doc("half its width in heading");
    is.param("lost_reach", &Params::lost_reach)
        .unit("m")
        .range(0.01, 20)
        .doc("where that does not help it is searched in all headings, so far to each side");
    is.param("patience", &Params::patience)
        .range(0, 1e6)
        .doc("after more in a row that do not fit the window is emptied and starts again");
  }

  Out run(const In& in, const Params& params, Context& context) const {
    std::vector<One<Segment>> held(in.segments.size());
    context.parallel(held.size(), [&](std::size_t k) { held[k] = in.segments.open(k); });
    std::vector<const Cloud*> scans(held.size());
    for (std::size_t k = 0; k < held.size(); ++k) scans[k] = &held[k]->cloud;
    Tracked tracked = track(scans, *in.poses, *in.edges, options_of(params));

    const auto count = [&](const char* what, std::size_t n) {
      if (n) context.count(what, n);
    };
    count("iterations", static_cast<std::size_t>(tracked.iterations));
    count("scans searched for", tracked.searched);
    count("scans that did not fit", tracked.unfit);
    count("windows started again", tracked.restarts);
    if (tracked.unfit)
      context.warn(std::to_string(tracked.unfit) + " of " + std::to_string(tracked.laid) +
                   " scans do not fit those before them: the expected motion stands there");
    const double n = std::max<double>(1, static_cast<double>(tracked.laid));
    Out out;
    out.metrics.add("registrations", static_cast<double>(tracked.laid), "")
        .add("iterations", tracked.iterations / n, "")
        .add("mae", tracked.mae / n, "m")
        .add("overlap", tracked.overlap / n, "")
        .add("searched", static_cast<double>(tracked.searched), "")
        .add("unfit", static_cast<double>(tracked.unfit), "")
        .add("resets", static_cast<double>(tracked.restarts), "");
    out.poses = std::move(tracked.poses);
    return out;
  }

 private:
  static TrackOptions options_of(const Params& params) {
    TrackOptions options;
    options.frames = params.frames, options.leaf = params.leaf, options.radius = params.radius;
    options.search_reach = params.search_reach, options.search_turn = params.search_turn;
    options.lost_reach = params.lost_reach;
    options.icp.stop = params.stop, options.icp.metric = params.metric,
    options.icp.reach = params.reach;
    options.icp.iterations = params.iterations, options.icp.change = params.change,
    options.icp.ratio = params.ratio;
    options.icp.hold = params.hold;
    options.every = params.every, options.turn = params.turn,
    options.least_overlap = params.least_overlap;
    options.search_below = params.search_below, options.search_blind = params.search_blind;
    options.patience = params.patience;
    return options;
  }
};

}  // namespace
}  // namespace plumb

PLUMB_MODULE(plumb::TrackSlidingWindow)
