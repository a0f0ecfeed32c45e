#include "plumb/slam/step.hpp"

#include "plumb/plugin/module.hpp"
#include "plumb/slam/segment.hpp"
#include "track.hpp"

namespace plumb::track_sliding_window {
namespace {

using planar::Metric;
using planar::Stop;

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
  struct Params : TrackOptions {
    std::string check() const {
      return icp.start_sigma && icp.metric == Metric::point
                 ? "'odometry_sigma' goes with 'metric: line'"
                 : "";
    }
  };

  static void describe(Declaration<TrackSlidingWindow>& is) {
    is.name("track.sliding_window")
        .version(1)
        .source("[Zhang2023] 2; registration to the submap is ours");
    is.summary("Tracks a 2-D laser by registering each scan to the submap of the scans before it.");
    is.input("segments", &In::segments, "the scans in order, one per segment, in the plane");
    is.input("poses", &In::poses, "their poses from odometry; all equal where there is none");
    is.input("edges", &In::edges,
             "the chain of accepted scans; an edge that is not sequential restarts the window");
    is.output("poses", &Out::poses, "poses of the scans; those outside the chain are interpolated");
    is.output("metrics", &Out::metrics,
              "scans registered; means of iterations, distances and overlap; windows restarted");
    describe_window(is);
    describe_registration(is);
    describe_search(is);
    is.param("patience", &Params::patience)
        .range(0, 1e6)
        .doc("after more scans in a row that do not fit, the window is cleared and restarts");
  }

  Out run(const In& in, const Params& params, Context& context) const {
    std::vector<One<Segment>> held(in.segments.size());
    context.parallel(held.size(), [&](std::size_t k) { held[k] = in.segments.open(k); });
    std::vector<const Cloud*> scans(held.size());
    for (std::size_t k = 0; k < held.size(); ++k) scans[k] = &held[k]->cloud;
    Tracked tracked = track(scans, *in.poses, *in.edges, params);

    const auto count = [&](const char* what, std::size_t n) {
      if (n) context.count(what, n);
    };
    count("iterations", static_cast<std::size_t>(tracked.iterations));
    count("scans whose pose was searched for", tracked.searched);
    count("scans that did not fit", tracked.unfit);
    count("windows restarted", tracked.restarts);
    if (tracked.unfit)
      context.warn(std::to_string(tracked.unfit) + " of " + std::to_string(tracked.registered) +
                   " scans do not fit those before them: the predicted motion is used there");
    const double n = std::max<double>(1, static_cast<double>(tracked.registered));
    Out out;
    out.metrics.add("registrations", static_cast<double>(tracked.registered), "")
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
  static void describe_window(Declaration<TrackSlidingWindow>& is) {
    is.param("frames", &Params::frames)
        .range(1, 1000)
        .doc("scans in the window")
        .source("[Zhang2023] 2");
    is.param("min_translation", &Params::min_translation)
        .unit("m")
        .range(0, 100)
        .doc(
            "a scan joins the window when it is farther than this from the window's newest; 0: "
            "each does");
    is.param("min_rotation", &Params::min_rotation)
        .unit("rad")
        .range(0, 360 * deg)
        .doc("or rotated by more than this");
    is.param("voxel_size", &Params::voxel_size)
        .unit("m")
        .range(0.001, 10)
        .doc(
            "points of the submap this close to a kept point are merged with it into their mean; "
            "none: every point is kept");
    is.param("radius", &Params::radius)
        .unit("m")
        .range(0.01, 10)
        .doc("radius of the neighbourhood for a point's normal");
  }

  static void describe_registration(Declaration<TrackSlidingWindow>& is) {
    is.params(&Params::icp, {"stop", "metric", "max_correspondence_distance", "max_iterations",
                             "change", "ratio", "start_sigma"});
    is.param("metric").choices({{"line", "point-to-line distance, along the submap's normal"},
                                {"point", "point-to-point distance"}});
    is.param("max_iterations").range(1, 10000).doc("iterations of one registration");
    is.param("start_sigma")
        .named("odometry_sigma")
        .doc(
            "with metric line, standard deviation of the odometry's translation from scan to scan, "
            "a third of it in rad for the heading; none: no prior");
    is.param("min_overlap", &Params::min_overlap)
        .range(0, 1)
        .doc(
            "share of a scan's points that must have a pair; else the predicted motion is used and "
            "the scan does not join the window");
  }

  static void describe_search(Declaration<TrackSlidingWindow>& is) {
    is.param("search_below", &Params::search_below)
        .range(0, 1)
        .doc(
            "where the overlap is lower, a window around the predicted pose is searched; none: "
            "never");
    is.param("search_blind", &Params::search_blind)
        .range(0, 1)
        .doc("the same where there is no odometry, if it is greater");
    is.param("search_window", &Params::search_window)
        .unit("m")
        .range(0.01, 20)
        .doc("half width of the search window");
    is.param("search_angle", &Params::search_angle)
        .unit("rad")
        .range(0.05 * deg, 180 * deg)
        .doc("half width of the search window in heading");
    is.param("lost_search_window", &Params::lost_search_window)
        .unit("m")
        .range(0.01, 20)
        .doc("half width of a second search, in all headings, where the first does not succeed");
  }
};

}  // namespace
}  // namespace plumb::track_sliding_window

PLUMB_MODULE(plumb::track_sliding_window::TrackSlidingWindow)
