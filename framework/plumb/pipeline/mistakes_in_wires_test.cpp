/// Mistakes in what is wired to what, in repeats and in what nothing uses.
#include <gmock/gmock.h>

#include "plumb/pipeline/testing/mistakes_testing.hpp"

namespace plumb {
namespace {

using test::cascade;
using test::told;
using test::told_with;
using test::with;
using testing::HasSubstr;

TEST(Mistakes, InWires) {
  EXPECT_THAT(told_with("from: merged", "from: megred"),
              HasSubstr("a.yaml:12:44: nothing here is called 'megred'."));
  EXPECT_THAT(told_with("from: merged", "from: megred"), HasSubstr("Did you mean 'merged'?"));
  EXPECT_THAT(told_with("from: sequence.trajectory", "from: sequence.trajectroy"),
              HasSubstr("has no output 'trajectroy'.\n"));
  EXPECT_THAT(told_with("poses: drift.solved}}", "poses: drift.slved}}"),
              HasSubstr("there is no step 'slved' in 'drift'."));
  EXPECT_THAT(told_with("poses: drift.solved}}", "poses: drift}}"),
              HasSubstr("'drift' is a group, not a step."));
  EXPECT_THAT(told_with("poses: drift.solved}}", "poses: coarse.poses}}"),
              HasSubstr("carries from pass to pass, not seen from outside"));
  EXPECT_THAT(told_with("{frames: ranged, ranges: ranges}", "{frame: ranged, ranges: ranges}"),
              HasSubstr("it has no input 'frame'."));
  EXPECT_THAT(told_with("{frames: ranged, ranges: ranges}", "{frames: ranged}"),
              HasSubstr("its input 'ranges' is not wired, it wants FrameRange, one per segment."));
  EXPECT_THAT(told_with("features: fpfh}}\n      solved", "features: segments}}\n      solved"),
              HasSubstr("its input 'features' wants Features, one per segment, but 'segments' "
                        "gives Segment, one per segment."));
  EXPECT_THAT(told_with("features: fpfh}}\n      solved", "features: segments}}\n      solved"),
              HasSubstr("Of type Features: fpfh."));
  EXPECT_THAT(
      told_with("from: segments}", "from: sequence}"),
      HasSubstr(
          "'sequence' gives Frame, one per frame and Trajectory, which fits none of its inputs."));
  EXPECT_THAT(told_with("edges, segments: segments, poses: solved}",
                        "[edges, drift.neighbours], segments: segments, poses: solved}"),
              HasSubstr("expected the name of a step, found a list"));
}

TEST(Mistakes, InWiresThatFitInMoreThanOneWay) {
  const std::string more = cascade + "  extra: {use: register.icp, from: segments}\n";
  EXPECT_THAT(told(more), HasSubstr("'segments' fits in more than one way."));
  EXPECT_THAT(told(more), HasSubstr("{targets: segments} or {sources: segments}"));
}

TEST(Mistakes, InWiresAreNoneWhereOneFitsWhatAStepNeedsAndWhatItMayBeGiven) {
  const std::string all =
      told(cascade + "  extra: {use: measure.match_rmse, from: ranges.poses}\n");
  EXPECT_THAT(all, HasSubstr("its input 'edges' is not wired"));
  EXPECT_THAT(all, HasSubstr("its input 'segments' is not wired"));
  EXPECT_THAT(all, testing::Not(HasSubstr("'poses' is not wired")));
  EXPECT_THAT(all, testing::Not(HasSubstr("more than one way")));
}

TEST(Mistakes, InItemKinds) {
  // An EdgeStep sees one edge's matches; the solver sees all of them.
  EXPECT_THAT(
      told_with("matches: kept, poses: poses}, with: {loss",
                "matches: edges, poses: poses}, with: {loss"),
      HasSubstr("its input 'matches' wants Matches, one per edge, but 'edges' gives Edges."));
}

TEST(Mistakes, InWhatAnEdgeStepTakesOfTheWholePipeline) {
  // Every edge sees the same Metrics; Matches are still its own.
  const auto scaled = [](const std::string& from) {
    return told_with("{matches: found, poses: poses}",
                     "{matches: found, poses: poses, scale: " + from + "}");
  };
  EXPECT_EQ(scaled("drift.solved"), "");
  EXPECT_EQ(scaled("drift.solved.metrics"), "");
  EXPECT_THAT(
      scaled("found"),
      HasSubstr("its input 'scale' wants Metrics, but 'found' gives Matches, one per edge."));
  EXPECT_THAT(
      told_with("{matches: found, poses: poses}", "{matches: drift.solved.metrics, poses: poses}"),
      HasSubstr("its input 'matches' wants Matches, one per edge, but 'drift.solved.metrics' gives "
                "Metrics."));
}

TEST(Mistakes, InCycles) {
  const std::string text =
      with("{segments: segments, poses: ranges.poses}", "{segments: segments, poses: solved}");
  EXPECT_THAT(told(text),
              HasSubstr("a.yaml:16:7: these steps wait for each other: drift.neighbours -> "
                        "drift.matches -> drift.solved -> drift.neighbours."));
  EXPECT_THAT(told("plumb: 1\nsteps:\n  a: {use: solve.pose_graph, from: a}\n"),
              HasSubstr("a -> a."));
}

TEST(Mistakes, InDomains) {
  const std::string text = with(
      "  fpfh:     {use: describe.fpfh, from: segments}",
      "  others: {use: segment.by_count, from: sequence.trajectory, with: {frames: 10}}\n"
      "  small:  {use: segment.merge, from: {frames: ranged, ranges: others}}\n"
      "  fpfh:   {use: describe.fpfh, from: small}\n"
      "  odd: {use: edges.overlap, from: {segments: small, poses: ranges}}\n"
      "  mixed: {use: prune.distance, from: {matches: drift.matches, poses: ranges, edges: odd}}\n"
      "  used: {use: solve.pose_graph, from: {matches: mixed, poses: ranges}}");
  EXPECT_THAT(told(text), HasSubstr("step 'mixed' (prune.distance): its inputs 'matches' and "
                                    "'edges' belong to different items: those of "
                                    "'drift.neighbours' and those of 'odd'."));
}

TEST(Mistakes, InDomainsOfWhatBelongsToOtherItems) {
  EXPECT_THAT(told(R"(plumb: 1
steps:
  sequence: {use: source.sequence, with: {path: .}}
  ranges: {use: segment.by_count, from: sequence.trajectory}
  others: {use: segment.by_count, from: sequence.trajectory, with: {frames: 7}}
  pieces: {use: segment.merge, from: {frames: sequence, ranges: ranges}}
  small:  {use: segment.merge, from: {frames: sequence, ranges: others}}
  edges:  {use: edges.overlap, from: {segments: pieces, poses: ranges}}
  groups: {use: stitch.sliding_window, from: {segments: small, poses: others}}
  laid:   {use: register.icp, from: {edges: edges, targets: groups, sources: pieces}}
)"),
              HasSubstr("step 'laid' (register.icp): its inputs 'targets' and 'sources' belong to "
                        "different items: those of 'others' and those of 'ranges'."));
}

TEST(Mistakes, InRepeats) {
  EXPECT_THAT(
      told_with("gate: [4 m, 2 m, 1 m]", "gate: [4 m, 2 m, 1 m]\n        other: [1, 2]"),
      HasSubstr("a.yaml:24:16: repeat 'coarse': the row 'other' has 2 values, 'gate' has 3."));
  EXPECT_THAT(told_with("gate: [4 m, 2 m, 1 m]", "gate: [4 m, 2 m, 1 m]\n        other: 3"),
              HasSubstr("no step uses the row 'other'"));
  EXPECT_THAT(told_with("gate: [4 m, 2 m, 1 m]", "gate: [4 m, 2, 1 m]"),
              HasSubstr("a.yaml:23:21: step 'coarse.near' (prune.distance): parameter 'max': row "
                        "'gate': '2' has no unit"));
  EXPECT_THAT(told_with("gate: [4 m, 2 m, 1 m]", "gate: []"), HasSubstr("the row 'gate' is empty"));
  EXPECT_THAT(told_with("gate: [", "voxel: ["),
              HasSubstr("has the name of a parameter of the pipeline"));
  EXPECT_THAT(told_with("carry: {poses: solved}", "carry: {poses: kept}"),
              HasSubstr("starts as Poses and Metrics and is carried on as Matches, one per edge."));
  EXPECT_THAT(told_with("carry: {poses: solved}", "carry: {poses: drift.solved}"),
              HasSubstr("carried on from a step of the body"));
  EXPECT_THAT(told_with("carry: {poses: solved}", "carry: {poses: poses}"),
              HasSubstr("carried on from a step of the body, and 'poses' is none."));
  EXPECT_THAT(told_with("carry: {poses: solved}", "carry: {poses: solved, more: solved}"),
              HasSubstr("'start' does not say what it is"));
  EXPECT_THAT(told_with("start: {poses: drift.solved}", "start: {poses: coarse.solved}"),
              HasSubstr("must start with something from before the repeat"));
  EXPECT_THAT(told_with("start: {poses: drift.solved}", "start: {poses: drift.solved, p: ranges}"),
              HasSubstr("'start' names 'p', which is not carried."));
  EXPECT_THAT(told_with("metric: rmse", "metric: kept"), HasSubstr("'kept' gives no Metrics."));
  EXPECT_THAT(told_with("metric: rmse", "metric: drift.solved"),
              HasSubstr("'drift.solved' is not in the body"));
  EXPECT_THAT(told_with("than: 2 %", "than: 2"), HasSubstr("'2' has no unit, expected a ratio"));
  EXPECT_THAT(told_with("falls_by_less_than: 2 %", "below: 2 metres"), HasSubstr("is not a unit"));
  EXPECT_THAT(told_with("at_least: 2", "at_least: 9"),
              HasSubstr("at least 9 passes, but at most 6."));
  EXPECT_THAT(told_with("at_most: 6", "at_most: 2"), HasSubstr("the last are never reached"));
  EXPECT_THAT(told_with("if_exhausted: warn", "if_exhausted: panic"),
              HasSubstr("'panic' is not one of the choices"));
  EXPECT_THAT(told_with("      until: {all: [{metric: rmse, falls_by_less_than: 2 %}]}\n", ""),
              HasSubstr("'at_least' means nothing without 'until'"));
}

TEST(Mistakes, OfWritingWhatNothingUses) {
  EXPECT_THAT(told_with("parameters:", "parameters:\n  extra: {type: number, default: 3}"),
              HasSubstr("a.yaml:5:3: nothing uses the parameter 'extra'."));
  EXPECT_THAT(told(cascade + "  again: {use: describe.fpfh, from: segments}\n"),
              HasSubstr("step 'again' (describe.fpfh): nothing uses what it makes."));
  EXPECT_THAT(told(cascade + "  missing: {use: source.sequence}\n"),
              HasSubstr("parameter 'path' is missing, a path."));
}

}  // namespace
}  // namespace plumb
