#include "plumb/slam/step.hpp"

#include "gate.hpp"
#include "plumb/plugin/module.hpp"
#include "plumb/slam/trajectory.hpp"

namespace plumb::gate_distance {
namespace {

struct GateDistance : WholeStep {
  struct In {
    Each<Segment> segments;
    One<Trajectory> trajectory;
  };
  struct Out {
    Edges edges;
    Metrics metrics;
  };
  using Params = GateOptions;

  static void describe(Declaration<GateDistance>& is) {
    is.name("gate.distance").version(2).source("[Zhang2023] eq. 13");
    is.summary(
        "Builds a chain of consecutive scans, leaving out those whose distance to the surroundings "
        "jumps.");
    is.input("segments", &In::segments, "the scans in order, one per segment");
    is.optional_input(
        "trajectory", &In::trajectory,
        "the frames' stamps: with them an interval without scans starts a new window");
    is.output("edges", &Out::edges, "the chain: each accepted scan and the accepted one before it");
    is.output("metrics", &Out::metrics, "scans accepted and dropped, windows restarted");
    is.param("limit", &Params::limit)
        .range(0, 1)
        .doc(
            "upper bound of (r0 - r1)^2 / (r0 + r1)^2, where r is the distance of a scan's "
            "centroid from the sensor")
        .source("[Zhang2023] eq. 13");
    is.param("patience", &Params::patience)
        .range(0, 1e6)
        .doc(
            "after this many scans dropped in a row the window is cleared and restarts with the "
            "present scan");
    is.param("max_time_gap", &Params::max_time_gap)
        .unit("s")
        .range(0, 1e9)
        .doc(
            "after a longer interval without scans, if it is also longer than 'patience' usual "
            "ones, the window restarts; none: never");
    is.param("min_points", &Params::min_points)
        .range(1, 1e6)
        .doc("scans with fewer points are dropped");
  }

  Out run(const In& in, const Params& params, Context& context) const {
    std::vector<Seen> scans(in.segments.size());
    context.parallel(scans.size(), [&](std::size_t k) {
      const auto segment = in.segments.open(k);
      scans[k] = {segment->centroid.cast<double>().norm(), segment->cloud.size()};
      if (!in.trajectory) return;
      const FrameRange& range = segment->range;
      if (range.size() == 0 || range.end > in.trajectory->size())
        throw Error("a segment holds frames up to " + std::to_string(range.end) +
                    ", the trajectory has " + std::to_string(in.trajectory->size()) +
                    ": wire the trajectory that the segments were cut from");
      scans[k].begin = in.trajectory->stamps[range.first],
      scans[k].end = in.trajectory->stamps[range.end - 1];
    });
    Gated gated = gated_chain(scans, params);
    const auto count = [&](const char* what, std::size_t n) {
      if (n) context.count(what, n);
    };
    count("scans dropped for a jump", gated.far);
    count("scans dropped for too few points", gated.empty);
    count("windows restarted", gated.resets);
    count("of these after a stretch without scans", gated.gaps);
    if (gated.accepted < 2)
      context.warn("fewer than two scans of " + std::to_string(scans.size()) +
                   " are accepted: there is no chain");
    Out out;
    out.metrics.add("accepted", static_cast<double>(gated.accepted), "")
        .add("dropped", static_cast<double>(gated.far + gated.empty), "")
        .add("resets", static_cast<double>(gated.resets), "");
    out.edges = std::move(gated.edges);
    return out;
  }
};

}  // namespace
}  // namespace plumb::gate_distance

PLUMB_MODULE(plumb::gate_distance::GateDistance)
