#include "plumb/slam/step.hpp"

#include <array>
#include <cstdio>

#include "agreement.hpp"
#include "plumb/data/counted.hpp"
#include "plumb/plugin/module.hpp"

namespace plumb::accept_poses {
namespace {

std::string rounded(double metres) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4f m", metres);
  return text;
}

struct AcceptPoses : WholeStep {
  struct In {
    One<Poses> before;
    One<Poses> after;
    One<Edges> edges;
    Each<Segment> segments;
    One<Metrics> scale;
  };
  struct Out {
    Poses poses;
    Metrics metrics;
  };
  struct Params {
    double max_distance = 1;
    std::uint32_t max_points = 300;
    double tolerance = 0.03;
  };

  static void describe(Declaration<AcceptPoses>& is) {
    is.name("accept.poses").version(1).source("ours");
    is.summary(
        "Keeps a stage's new poses only if the clouds, judged on points selected anew, agree at "
        "least as well as before.");
    is.input("before", &In::before, "poses of the segments before the stage");
    is.input("after", &In::after, "poses of the segments after the stage");
    is.input("edges", &In::edges, "pairs of segments that should agree");
    is.input("segments", &In::segments, "their clouds, preferably with normals");
    is.scale(&In::scale);
    is.output("poses", &Out::poses,
              "'after', or 'before' where the stage made the agreement worse, which is noted");
    is.output("metrics", &Out::metrics,
              "1 if accepted, else 0; mean distances before and after, along the path and between "
              "visits");
    is.param("max_distance", &Params::max_distance)
        .unit("m")
        .range(1e-3, 1000)
        .doc("distances to the nearest point of the other segment are truncated at this value");
    is.param("max_points", &Params::max_points)
        .range(10, 1e9)
        .doc("points of a segment that are tested for each edge, evenly selected");
    is.param("tolerance", &Params::tolerance)
        .unit("%")
        .range(0, 10)
        .doc("relative increase of the mean distance that still counts as equal");
  }

  /// Sums over the edges of one class.
  struct Side {
    double before = 0, after = 0;
    std::size_t edges = 0;
    double mean(double sum) const { return edges ? sum / static_cast<double>(edges) : 0; }
  };

  Out run(const In& in, const Params& params, Context& context) const {
    const std::size_t count = in.segments.size();
    if (in.before->size() != count || in.after->size() != count || in.edges->segments != count)
      throw Error("got " + counted(count, "segments") + ", " + counted(in.before->size(), "poses") +
                  " before and " + std::to_string(in.after->size()) + " after, and edges of " +
                  counted(in.edges->segments, "segments") +
                  ": wire what belongs to the same segments");
    const auto& edges = in.edges->list;
    std::vector<std::array<double, 2>> values(edges.size());
    const AgreementOptions options{params.max_distance, params.max_points};
    context.parallel(edges.size(), [&](std::size_t k) {
      const auto i = in.segments.open(edges[k].i), j = in.segments.open(edges[k].j);
      const Pose before = in.before->relative(edges[k].j, edges[k].i),
                 after = in.after->relative(edges[k].j, edges[k].i);
      const auto points = common_points(*i, *j, before, after, options);
      values[k] = {disagreement(*i, *j, points, before, options),
                   disagreement(*i, *j, points, after, options)};
      // Clouds that are apart disagree as much as is counted.
      for (double& value : values[k])
        if (value < 0) value = params.max_distance;
    });
    Side along, visits;
    for (std::size_t k = 0; k < edges.size(); ++k) {
      Side& side = edges[k].kind == EdgeKind::sequential ? along : visits;
      side.before += values[k][0], side.after += values[k][1];
      ++side.edges;
    }
    const auto worse = [&](const Side& side) {
      return side.after > (1 + params.tolerance) * side.before;
    };
    const bool accepted = !worse(along) && !worse(visits);
    Out out{accepted ? *in.after : *in.before, {}};
    out.metrics.add("accepted", accepted, "")
        .add("sequential_before", along.mean(along.before), "m")
        .add("sequential_after", along.mean(along.after), "m")
        .add("others_before", visits.mean(visits.before), "m")
        .add("others_after", visits.mean(visits.after), "m");
    if (!accepted) {
      const Side& side = worse(along) ? along : visits;
      out.metrics.notes.push_back(
          "the stage made it worse and is not taken: points of their clouds lie " +
          rounded(side.mean(side.before)) + " from the neighbours' surfaces before and " +
          rounded(side.mean(side.after)) + " after it (" +
          (worse(along) ? "consecutive segments" : "other edges") + ")");
    }
    return out;
  }
};

}  // namespace
}  // namespace plumb::accept_poses

PLUMB_MODULE(plumb::accept_poses::AcceptPoses)
