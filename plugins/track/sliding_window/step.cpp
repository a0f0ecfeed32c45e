#include "plumb/data/segment.hpp"
#include "plumb/plugin/module.hpp"
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
  struct Params {
    std::uint32_t frames = 10;
    double min_translation = 0.25, min_rotation = 15 * deg;
    std::optional<double> voxel_size = 0.05;
    double radius = 0.25;
    Stop stop = Stop::ratio;
    Metric metric = Metric::line;
    double max_correspondence_distance = 0.3;
    std::uint32_t max_iterations = 50;
    double change = 1e-4, ratio = 0.95;
    std::optional<double> odometry_sigma;
    double min_overlap = 0.5;
    std::optional<double> search_below = 0.9;
    double search_blind = 0.98;
    double search_window = 0.6, search_angle = 30 * deg, lost_search_window = 1.5;
    std::uint32_t patience = 5;
    std::string check() const {
      return odometry_sigma && metric == Metric::point ? "'odometry_sigma' goes with 'metric: line'"
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
    is.choice("stop", &Params::stop,
              {{"ratio", Stop::ratio,
                "when the mean distance of the pairs stops decreasing: IA-ICP, eq. (12)"},
               {"change", Stop::change, "when the pose converges: standard ICP"}})
        .doc("when a registration ends")
        .source("[Zhang2023] eq. (12)");
    is.choice("metric", &Params::metric,
              {{"line", Metric::line, "point-to-line distance, along the submap's normal"},
               {"point", Metric::point, "point-to-point distance"}})
        .doc("the error that is minimised")
        .source("[Zhang2023] eq. (3)");
    is.param("max_correspondence_distance", &Params::max_correspondence_distance)
        .unit("m")
        .range(1e-3, 100)
        .doc("distance between the two points of a pair");
    is.param("max_iterations", &Params::max_iterations)
        .range(1, 10000)
        .doc("iterations of one registration");
    is.param("change", &Params::change)
        .range(1e-9, 1)
        .doc("converged when an iteration moves the pose by less, m and rad added");
    is.param("ratio", &Params::ratio)
        .range(0, 1)
        .doc("stops when the mean distance is at least this times that of the iteration before")
        .source("[Zhang2023] 2");
    is.param("odometry_sigma", &Params::odometry_sigma)
        .unit("m")
        .range(1e-4, 100)
        .doc(
            "with metric line, standard deviation of the odometry's translation from scan to scan, "
            "a third of it in rad for the heading; none: no prior");
    is.param("min_overlap", &Params::min_overlap)
        .range(0, 1)
        .doc(
            "share of a scan's points that must have a pair; else the predicted motion is used and "
            "the scan does not join the window");
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
    is.param("patience", &Params::patience)
        .range(0, 1e6)
        .doc("after more scans in a row that do not fit, the window is cleared and restarts");
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
  static TrackOptions options_of(const Params& params) {
    TrackOptions options;
    options.frames = params.frames, options.voxel_size = params.voxel_size,
    options.radius = params.radius;
    options.search_window = params.search_window, options.search_angle = params.search_angle;
    options.lost_search_window = params.lost_search_window;
    options.icp.stop = params.stop, options.icp.metric = params.metric,
    options.icp.max_correspondence_distance = params.max_correspondence_distance;
    options.icp.max_iterations = params.max_iterations, options.icp.change = params.change,
    options.icp.ratio = params.ratio;
    options.icp.start_sigma = params.odometry_sigma;
    options.min_translation = params.min_translation, options.min_rotation = params.min_rotation,
    options.min_overlap = params.min_overlap;
    options.search_below = params.search_below, options.search_blind = params.search_blind;
    options.patience = params.patience;
    return options;
  }
};

}  // namespace
}  // namespace plumb::track_sliding_window

PLUMB_MODULE(plumb::track_sliding_window::TrackSlidingWindow)
