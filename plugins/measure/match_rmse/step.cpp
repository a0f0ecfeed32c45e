#include "plumb/slam/step.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "match_rmse.hpp"
#include "plumb/plugin/module.hpp"

namespace plumb::measure_match_rmse {
namespace {

struct MatchRmse : WholeStep {
  struct In {
    One<Edges> edges;
    Each<Segment> segments;
    Several<Poses> poses;
    One<Poses> pairs;
    One<Metrics> scale;
  };
  struct Out {
    Metrics metrics;
  };
  struct Params {
    double max_correspondence_distance = 0.5;
    std::optional<std::uint32_t> max_points;
  };

  static void describe(Declaration<MatchRmse>& is) {
    is.name("measure.match_rmse")
        .version(1)
        .summary(
            "Measures the RMSE of nearest-point matches between neighbouring segments, averaged "
            "over all edges.")
        .source("[Tang2024] eq. 3, 3.3; pairs found once are ours");
    is.input("edges", &In::edges, "pairs of segments that are compared");
    is.input("segments", &In::segments, "their clouds, downsampled as they are to be compared");
    is.input("poses", &In::poses, "poses of the segments; one number for each, by its label");
    is.optional_input("pairs", &In::pairs,
                      "poses under which the pairs are found, once for all; without it, each of "
                      "'poses' has its own pairs");
    is.scale(&In::scale);
    is.output("metrics", &Out::metrics,
              "a number for each of 'poses', and under the last of them a record for each edge");
    is.param("max_correspondence_distance", &Params::max_correspondence_distance)
        .unit("m")
        .range(1e-3, 100)
        .doc("distance between the two points of a pair");
    is.param("max_points", &Params::max_points)
        .range(1, 1e9)
        .doc("points of an edge's first segment that are matched, evenly selected; none: all");
  }

  /// What one edge gives: for each labelled poses the rmse (NaN: no pairs), and for the last the
  /// pairs asked for and found.
  struct Result {
    std::vector<double> rmse;
    std::uint32_t asked = 0, found = 0;
  };

  Result measure(const In& in, const Edge& edge, const Params& params) const {
    const auto i = in.segments.open(edge.i), j = in.segments.open(edge.j);
    Result result;
    IndexPairs pairs;
    if (in.pairs)
      pairs = nearest_pairs(*i, *j, in.pairs->relative(edge.j, edge.i),
                            params.max_correspondence_distance, params.max_points);
    for (const auto& [label, poses] : in.poses) {
      const Pose T_j_i = poses->relative(edge.j, edge.i);
      if (!in.pairs)
        pairs = nearest_pairs(*i, *j, T_j_i, params.max_correspondence_distance, params.max_points);
      result.rmse.push_back(rmse_of(pairs, *i, *j, T_j_i));
    }
    const std::size_t n = i->cloud.size();
    result.asked = static_cast<std::uint32_t>(
        params.max_points ? std::min<std::size_t>(n, *params.max_points) : n);
    result.found = static_cast<std::uint32_t>(pairs.size());
    return result;
  }

  Out run(const In& in, const Params& params, Context& context) const {
    const std::size_t segments = in.segments.size();
    for (const auto& [label, poses] : in.poses) require_pose_each(*poses, segments);
    if (in.pairs) require_pose_each(*in.pairs, segments);
    const auto& edges = in.edges->list;
    for (const auto& edge : edges)
      if (edge.i >= segments || edge.j >= segments)
        throw Error("an edge names a segment beyond the " + std::to_string(segments) +
                    " that there are; wire edges of the same segments");

    std::vector<Result> results(edges.size());
    context.parallel(edges.size(),
                     [&](std::size_t k) { results[k] = measure(in, edges[k], params); });

    Out out;
    for (std::size_t label = 0; label < in.poses.size(); ++label) {
      double sum = 0;
      std::size_t with_pairs = 0;
      for (const auto& result : results)
        if (!std::isnan(result.rmse[label])) sum += result.rmse[label], ++with_pairs;
      const double mean = with_pairs ? sum / static_cast<double>(with_pairs)
                                     : std::numeric_limits<double>::quiet_NaN();
      const auto& name = in.poses[label].label;
      out.metrics.add(name.empty() ? "rmse" : name, mean, "m");
    }
    std::size_t without = 0;
    for (std::size_t k = 0; k < edges.size() && !in.poses.empty(); ++k) {
      const auto& e = edges[k];
      const double rmse = results[k].rmse.back();
      const bool none = std::isnan(rmse);
      without += none;
      out.metrics.edges.push_back({e.i, e.j, e.kind, results[k].asked, results[k].found,
                                   none ? 0 : rmse, none ? 0.0 : 1.0,
                                   none ? "no matches" : "accepted"});
    }
    if (without)
      out.metrics.notes.push_back(
          std::to_string(without) + " of " + std::to_string(edges.size()) +
          " edges have no pairs within max_correspondence_distance and are not in the mean");
    return out;
  }
};

}  // namespace
}  // namespace plumb::measure_match_rmse

PLUMB_MODULE(plumb::measure_match_rmse::MatchRmse)
