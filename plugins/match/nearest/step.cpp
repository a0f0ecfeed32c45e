
#include "plumb/slam/step.hpp"

#include "nearest.hpp"
#include "plumb/plugin/module.hpp"

namespace plumb::match_nearest {
namespace {

enum class Metric { point, plane };

struct Nearest : EdgeStep {
  struct In {
    OverEdges edges;
    Ends<Segment> segments;
    Relative poses;
    One<Metrics> scale;
  };
  struct Out {
    Matches matches;
  };
  struct Params {
    double max_correspondence_distance = 1;
    Metric metric = Metric::point;
    std::optional<std::uint32_t> max_points;
    std::optional<double> max_normal_angle;
    bool both_ways = false;
  };

  static void describe(Declaration<Nearest>& is) {
    is.name("match.nearest").version(1);
    is.summary("Matches each point of one segment with the nearest point of the other.");
    is.source("[Tang2024] 2.3.2; [Chen1992] for metric plane");
    is.input("edges", &In::edges, "pairs of segments");
    is.input("segments", &In::segments,
             "the clouds; with normals for 'metric: plane' and 'max_normal_angle'");
    is.input("poses", &In::poses, "the current poses of the segments");
    is.scale(&In::scale);
    is.output("matches", &Out::matches,
              "pairs no farther apart than 'max_correspondence_distance'");
    is.param("max_correspondence_distance", &Params::max_correspondence_distance)
        .unit("m")
        .range(0.001, 100)
        .doc("distance between the two points of a pair");
    is.choice("metric", &Params::metric,
              {{"point", Metric::point, "point-to-point distance"},
               {"plane", Metric::plane, "point-to-plane distance, along q's normal"}})
        .doc("the error that the solver minimises");
    is.param("max_points", &Params::max_points)
        .range(1, 4e9)
        .doc("points of a segment's overlapping part that are matched, evenly selected; none: all");
    is.param("max_normal_angle", &Params::max_normal_angle)
        .unit("rad")
        .range(0, 180 * deg)
        .doc("pairs whose normals differ by more are dropped; none: normals are not compared");
    is.param("both_ways", &Params::both_ways)
        .doc(
            "match the second segment's points with the first's too, which cancels the bias of "
            "one-sided matching");
  }

  Out run(const In& in, const Params& params, Context& context) const {
    const Segment &i = *in.segments.i, &j = *in.segments.j;
    if (i.cloud.empty() || j.cloud.empty()) return {};
    const auto demand_normals = [](const Segment& segment, const char* what) {
      if (!segment.cloud.has_normals())
        throw Error(std::string("'") + what +
                    "' needs normals and the segments have none: put "
                    "estimate.normals before, or leave '" +
                    what + "' out");
    };
    if (params.metric == Metric::plane) demand_normals(j, "metric: plane");
    if (params.metric == Metric::plane && params.both_ways) demand_normals(i, "both_ways");
    if (params.max_normal_angle)
      demand_normals(i, "max_normal_angle"), demand_normals(j, "max_normal_angle");
    Matches matches =
        nearest_pairs(i, j, in.poses.T_i_j,
                      {params.max_correspondence_distance, params.metric == Metric::plane,
                       params.max_points, params.max_normal_angle, params.both_ways});
    context.count("pairs dropped for unlike normals", matches.found - matches.size());
    if (matches.found == 0) context.count("edges without a pair", 1);
    return {std::move(matches)};
  }
};

}  // namespace
}  // namespace plumb::match_nearest

PLUMB_MODULE(plumb::match_nearest::Nearest)
