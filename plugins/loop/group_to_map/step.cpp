#include <numbers>

#include "group_to_map.hpp"
#include "plumb/data/values.hpp"
#include "plumb/plugin/module.hpp"

namespace plumb {
namespace {

struct LoopGroupToMap : WholeStep {
  struct In {
    Each<Segment> segments;
    One<Poses> poses;
    One<Relations> known;
  };
  struct Out {
    Relations relations;
    Metrics metrics;
  };
  using Params = LoopOptions;

  static void describe(Declaration<LoopGroupToMap>& is) {
    is.name("loop.group_to_map").version(1).source("[Zhang2023] 1, 2; [Olson2009]");
    is.summary("Finds loops: lays the group of the newest scans onto the map of earlier ones.");
    is.input("segments", &In::segments, "the clouds, in the plane");
    is.input("poses", &In::poses, "where the segments are at present");
    is.optional_input("known", &In::known, "loops found before, which make poses less uncertain");
    is.output("relations", &Out::relations, "a relative pose for each loop");
    is.output("metrics", &Out::metrics,
              "how many groups asked, places were tried, and why loops were refused");
    is.param("group", &Params::group)
        .range(1, 1000)
        .source("[Zhang2023] 2")
        .doc("segments that make a group");
    is.param("map", &Params::map)
        .range(0, 10000)
        .doc("segments of the map before and after the one that is asked about");
    is.param("stride", &Params::stride)
        .unit("m")
        .range(0, 1000)
        .doc("way between two groups that ask");
    is.param("gap", &Params::gap)
        .unit("m")
        .range(0.1, 1e5)
        .doc("least way between a group and what it may meet");
    is.param("turn_length", &Params::turn_length)
        .unit("m")
        .range(0, 10)
        .doc("a turn of one rad counts as so much way");
    is.param("near", &Params::near)
        .unit("m")
        .range(0.1, 100)
        .doc(
            "groups that passed each other closer, but for the uncertainty, are laid onto each "
            "other");
    is.param("drift", &Params::drift)
        .range(0, 1)
        .doc("metres of place that may have been lost for each metre of way");
    is.param("heading_drift", &Params::heading_drift)
        .unit("rad")
        .range(0, 1)
        .doc("heading that may have been lost for each metre of way");
    is.param("most_reach", &Params::most_reach)
        .unit("m")
        .range(0.1, 100)
        .doc("the search never reaches farther");
    is.param("most_turn", &Params::most_turn)
        .unit("rad")
        .range(0.01, std::numbers::pi)
        .doc("the search never turns farther");
    is.param("most_places", &Params::most_places)
        .range(1, 1000)
        .doc("earlier visits that a group is laid onto, the nearest");
    is.param("resolution", &Params::resolution).unit("m").range(0.01, 2).doc("grid of the search");
    is.param("range", &Params::range)
        .unit("m")
        .range(1, 1000)
        .doc("points farther from the middle of their group are left out");
    is.param("least_score", &Params::least_score)
        .range(0, 1)
        .doc("score that a loop must have: mean likelihood of its points");
    is.param("second_peak", &Params::second_peak)
        .range(0, 1)
        .doc("a loop is ambiguous where another peak has this share of its score");
    is.param("apart", &Params::apart)
        .unit("m")
        .range(0.01, 100)
        .doc("another peak lies at least so far away, or 0.25 rad");
    is.param("support", &Params::support)
        .range(0, 1000)
        .doc("loops within 10 m of way at both ends that must say the same");
    is.param("agree", &Params::agree)
        .unit("m")
        .range(0.001, 100)
        .doc(
            "how far such loops may differ, a third of it in rad, and 2 % of the way between them");
  }

  Out run(const In& in, const Params& params, Context& context) const {
    if (in.poses->size() != in.segments.size())
      throw Error("there are " + std::to_string(in.segments.size()) + " segments and " +
                  std::to_string(in.poses->size()) + " poses: wire poses of the same segments");
    auto found = find_loops([&](std::size_t k) { return in.segments.open(k).shared(); }, *in.poses,
                            in.known ? &*in.known : nullptr, params, context);
    Out out;
    out.metrics.add("loops", static_cast<double>(found.relations.relative.size()), "")
        .add("groups_asked", found.counts.asked, "")
        .add("places_tried", found.counts.tried, "")
        .add("score_too_low", found.counts.low, "")
        .add("ambiguous", found.counts.ambiguous, "")
        .add("without_support", found.counts.alone, "");
    if (found.relations.relative.empty())
      out.metrics.notes.push_back("no loop was found: the drift stays");
    out.relations = std::move(found.relations);
    return out;
  }
};

}  // namespace
}  // namespace plumb

PLUMB_MODULE(plumb::LoopGroupToMap)
