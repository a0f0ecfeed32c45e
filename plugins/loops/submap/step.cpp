#include "plumb/slam/step.hpp"

#include "plumb/plugin/module.hpp"
#include "plumb/slam/values.hpp"
#include "submap.hpp"

namespace plumb::loops_submap {
namespace {

struct LoopsSubmap : WholeStep {
  struct In {
    Each<Segment> segments;
    One<Poses> poses;
    One<Constraints> known;
  };
  struct Out {
    Constraints constraints;
    Metrics metrics;
  };
  using Params = LoopOptions;

  static void describe(Declaration<LoopsSubmap>& is) {
    is.name("loops.submap")
        .version(1)
        .source(
            "[Zhang2023] 1; the search and the acceptance are ours, after [Olson2009], [Hess2016], "
            "[Mangelson2018]");
    is.summary(
        "Finds loops by registering a submap of the newest scans to the map of earlier ones.");
    is.input("segments", &In::segments, "the clouds, in the plane");
    is.input("poses", &In::poses, "the current poses of the segments");
    is.optional_input("known", &In::known,
                      "loops found before, which reduce the uncertainty of the poses");
    is.output("constraints", &Out::constraints, "a relative pose for each loop");
    is.output("metrics", &Out::metrics,
              "how many submaps were searched for and places tried, and why loops were rejected");
    describe_candidates(is);
    describe_search(is);
    describe_acceptance(is);
  }

  Out run(const In& in, const Params& params, Context& context) const {
    require_pose_each(*in.poses, in.segments.size());
    auto found = find_loops([&](std::size_t k) { return in.segments.open(k).shared(); }, *in.poses,
                            in.known ? &*in.known : nullptr, params, context);
    Out out;
    out.metrics.add("loops", static_cast<double>(found.constraints.relative.size()), "")
        .add("groups_asked", found.counts.asked, "")
        .add("places_tried", found.counts.tried, "")
        .add("score_too_low", found.counts.low, "")
        .add("ambiguous", found.counts.ambiguous, "")
        .add("without_support", found.counts.alone, "");
    if (found.constraints.relative.empty())
      out.metrics.notes.push_back("no loop was found: the drift remains");
    out.constraints = std::move(found.constraints);
    return out;
  }

 private:
  static void describe_candidates(Declaration<LoopsSubmap>& is) {
    is.param("submap_segments", &Params::submap_segments)
        .range(1, 1000)
        .source("[Zhang2023] 2")
        .doc("segments in a submap");
    is.param("map_segments", &Params::map_segments)
        .range(0, 10000)
        .doc("segments of the map before and after the candidate");
    is.param("stride", &Params::stride)
        .unit("m")
        .range(0, 1000)
        .doc("path length between two submaps that are searched for");
    is.param("min_path_separation", &Params::min_path_separation)
        .unit("m")
        .range(0.1, 1e5)
        .doc("path length between a submap and a candidate");
    is.param("turn_length", &Params::turn_length)
        .unit("m")
        .range(0, 10)
        .doc("path length that a rotation by 1 rad counts as");
    is.param("max_distance", &Params::max_distance)
        .unit("m")
        .range(0.1, 100)
        .doc(
            "submaps that passed each other closer than this, plus the uncertainty, are "
            "candidates");
  }

  static void describe_search(Declaration<LoopsSubmap>& is) {
    is.param("drift", &Params::drift)
        .range(0, 1)
        .doc("uncertainty of the position for each metre of path");
    is.param("heading_drift", &Params::heading_drift)
        .unit("rad")
        .range(0, 60 * deg)
        .doc("uncertainty of the heading for each metre of path");
    is.param("max_search_window", &Params::max_search_window)
        .unit("m")
        .range(0.1, 100)
        .doc("upper bound of the search window's half width");
    is.param("max_search_angle", &Params::max_search_angle)
        .unit("rad")
        .range(0.5 * deg, 180 * deg)
        .doc("upper bound of the search window's half width in heading");
    is.param("max_places", &Params::max_places)
        .range(1, 1000)
        .doc("earlier visits that a submap is registered to, the nearest ones");
    is.param("resolution", &Params::resolution)
        .unit("m")
        .range(0.01, 2)
        .doc("edge length of a cell of the search grid");
    is.param("max_range", &Params::max_range)
        .unit("m")
        .range(1, 1000)
        .doc("points farther from the centre of their submap are left out");
  }

  static void describe_acceptance(Declaration<LoopsSubmap>& is) {
    is.param("min_score", &Params::min_score)
        .range(0, 1)
        .doc("score of an accepted loop: the mean likelihood of its points");
    is.param("max_second_peak", &Params::max_second_peak)
        .range(0, 1)
        .doc("a loop is ambiguous where a second peak has more than this share of its score");
    is.param("min_peak_distance", &Params::min_peak_distance)
        .unit("m")
        .range(0.01, 100)
        .doc("a second peak is at least this far away, or 0.25 rad");
    is.param("min_support", &Params::min_support)
        .range(0, 1000)
        .doc("other loops within 10 m of path at both ends that must agree");
    is.param("max_disagreement", &Params::max_disagreement)
        .unit("m")
        .range(0.001, 100)
        .doc(
            "difference of two loops that agree, a third of it in rad, plus 2 % of the path "
            "between them");
  }
};

}  // namespace
}  // namespace plumb::loops_submap

PLUMB_MODULE(plumb::loops_submap::LoopsSubmap)
