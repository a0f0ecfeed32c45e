#include <numbers>

#include "nearest.hpp"
#include "plumb/plugin/module.hpp"

namespace plumb {
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
    double max = 1;
    Metric metric = Metric::point;
    std::optional<std::uint32_t> most_points;
    std::optional<double> reject_normals;
    bool both_ways = false;
  };

  static void describe(Declaration<Nearest>& is) {
    is.name("match.nearest").version(1);
    is.summary("Pairs each point of one segment with the nearest point of the other.");
    is.source("[Tang2024] 2.3.2");
    is.input("edges", &In::edges, "which segments to pair");
    is.input("segments", &In::segments,
             "the clouds; with normals for 'metric: plane' and 'reject_normals'");
    is.input("poses", &In::poses, "where the segments are at present");
    is.scale(&In::scale);
    is.output("matches", &Out::matches, "pairs no farther apart than 'max'");
    is.param("max", &Params::max)
        .unit("m")
        .range(0.001, 100)
        .doc("farthest that a pair may be apart");
    is.choice("metric", &Params::metric,
              {{"point", Metric::point, "the solver shortens the whole distance of a pair"},
               {"plane", Metric::plane, "the solver shortens the part along q's normal"}})
        .doc("what the solver is to make small");
    is.param("most_points", &Params::most_points)
        .range(1, 4e9)
        .doc("so many of a segment's points near the other are asked, evenly spaced; none: all");
    is.param("reject_normals", &Params::reject_normals)
        .unit("rad")
        .range(0, std::numbers::pi)
        .doc("pairs whose normals differ by more are dropped; none: normals are not looked at");
    is.param("both_ways", &Params::both_ways)
        .doc(
            "the second segment's points ask too, for the nearest of the first: what is one-sided "
            "about nearest points cancels");
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
    if (params.reject_normals)
      demand_normals(i, "reject_normals"), demand_normals(j, "reject_normals");
    Matches matches = nearest_pairs(i, j, in.poses.T_i_j,
                                    {params.max, params.metric == Metric::plane, params.most_points,
                                     params.reject_normals, params.both_ways});
    context.count("pairs dropped for their normals", matches.found - matches.size());
    if (matches.found == 0) context.count("edges without a pair", 1);
    return {std::move(matches)};
  }
};

}  // namespace
}  // namespace plumb

PLUMB_MODULE(plumb::Nearest)
