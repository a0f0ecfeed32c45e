/// Every kind of mistake is found, at its place, with the nearest name.
#include <gmock/gmock.h>

#include "plumb/pipeline/test_steps.hpp"

namespace plumb {
namespace {

using test::cascade;
using testing::HasSubstr;
using testing::Not;

/// The diagnostics' text, with the folder cut off; "" when there is nothing to say.
std::string told(const std::string& text, std::vector<std::string> sets = {"input=data"}) {
  const test::Folder folder;
  Overlay overlay;
  overlay.sets = std::move(sets);
  try {
    read_pipeline(folder.write("a.yaml", text), overlay, test::registry());
  } catch (const PipelineError& error) {
    std::string all = error.what();
    const std::string prefix = folder.path().string() + "/";
    for (auto at = all.find(prefix); at != std::string::npos; at = all.find(prefix))
      all.erase(at, prefix.size());
    return all;
  }
  return "";
}

/// The cascade with one piece of text exchanged.
std::string with(const std::string& old, const std::string& fresh) {
  std::string text = cascade;
  const auto at = text.find(old);
  if (at == std::string::npos) throw std::logic_error("no '" + old + "' in the cascade");
  return text.replace(at, old.size(), fresh);
}
std::string told_with(const std::string& old, const std::string& fresh) {
  return told(with(old, fresh));
}

TEST(Mistakes, AreShownWithTheLineACaretAndTheCure) {
  EXPECT_EQ(told_with("leaf: $voxel", "laef: $voxel"),
            "a.yaml:12:59: step 'segments' (filter.voxel_grid): unknown parameter 'laef'.\n"
            "  12 |   segments: {use: filter.voxel_grid, from: merged, with: {laef: $voxel}}\n"
            "     |                                                           ^\n"
            "  Did you mean 'leaf' [length, 0.01 m to 100 m]?  Known: leaf, keep_normals.");
}

TEST(Mistakes, AreToldAllAtOnce) {
  std::string text = with("leaf: $voxel", "leaf: 3 deg");
  text.replace(text.find("frames: 30"), 10, "frames: 1e2");
  const std::string all = told(text);
  EXPECT_THAT(all, HasSubstr("a.yaml:9:79: "));
  EXPECT_THAT(all, HasSubstr("a.yaml:12:65: "));
  EXPECT_THAT(all, HasSubstr("a.yaml:6:3: nothing uses the parameter 'voxel'"));
}

TEST(Mistakes, InValues) {
  const auto leaf = [](const std::string& value) {
    return told_with("{leaf: $voxel}", "{leaf: " + value + "}");
  };
  EXPECT_THAT(leaf("0.3"), HasSubstr("a.yaml:12:65: step 'segments' (filter.voxel_grid): parameter "
                                     "'leaf': '0.3' has no unit"));
  EXPECT_THAT(leaf("0.3"), HasSubstr("Write the unit, as in '0.3 m'; known: m, cm, mm, km."));
  EXPECT_THAT(leaf("3 deg"), HasSubstr("'3 deg' is an angle, expected a length, 0.01 m to 100 m"));
  EXPECT_THAT(leaf("3 metre"), HasSubstr("'metre' behind the number is not a unit"));
  EXPECT_THAT(leaf("3 mm2"), HasSubstr("Did you mean 'mm'?"));
  EXPECT_THAT(leaf("\"3, m\""), HasSubstr("Leave out the quotes."));
  EXPECT_THAT(leaf("nan"), HasSubstr("'nan' is not a number"));
  EXPECT_THAT(leaf("inf m"), HasSubstr("is not a number"));
  EXPECT_THAT(leaf("1e999 m"), HasSubstr("out of the range of numbers"));
  EXPECT_THAT(leaf("200 m"),
              HasSubstr("'200 m' is out of range, expected length, 0.01 m to 100 m"));
  EXPECT_THAT(leaf("none"), HasSubstr("'none' is not a number"));
  EXPECT_THAT(leaf(""), HasSubstr("expected a length, 0.01 m to 100 m, found nothing"));
  EXPECT_THAT(leaf("[1 m]"), HasSubstr("found a list"));
  EXPECT_THAT(told_with("frames: 30", "frames: 30 m"), HasSubstr("'30 m' is not an integer"));
  EXPECT_THAT(told_with("frames: 30", "frames: 030"), HasSubstr("'030' is not an integer"));
  EXPECT_THAT(told_with("frames: 30", "frames: 0"),
              HasSubstr("out of range, expected integer, 1 to 10000"));
  EXPECT_THAT(told_with("leaf: $voxel", "leaf: $voxel, keep_normals: yes"),
              HasSubstr("'yes' is not a boolean"));
  EXPECT_THAT(told_with("loss: huber", "loss: hubre"),
              HasSubstr("'hubre' is not one of the choices"));
  EXPECT_THAT(told_with("loss: huber", "loss: hubre"), HasSubstr("Did you mean 'huber'?"));
  EXPECT_THAT(told_with("loss: huber", "share: 0.1"),
              HasSubstr("'0.1' has no unit, expected a ratio"));
  EXPECT_THAT(told_with("poses: ranges.poses}", "poses: ranges.poses}, with: {margin: 90 %}"),
              HasSubstr("'90 %' has a unit, expected a bare number"));
  EXPECT_EQ(told_with("loss: huber", "loss: none"), "");
  EXPECT_EQ(told_with("poses: ranges.poses}", "poses: ranges.poses}, with: {threshold: none}"), "");
}

TEST(Mistakes, InReferencesToParameters) {
  EXPECT_THAT(told_with("leaf: $voxel", "leaf: $voxle"),
              HasSubstr("a.yaml:12:65: step 'segments' (filter.voxel_grid): parameter 'leaf': "
                        "nothing is called '$voxle'."));
  EXPECT_THAT(told_with("leaf: $voxel", "leaf: $voxle"), HasSubstr("Did you mean 'voxel'?"));
  EXPECT_THAT(told_with("leaf: $voxel", "leaf: $gate"),
              HasSubstr("nothing is called '$gate'"));  // a row of another scope
  EXPECT_THAT(told_with("frames: 30", "frames: $voxel"),
              HasSubstr("'$voxel' does not serve: it is a length, expected an integer"));
  EXPECT_THAT(told_with("path: $input", "path: $input/sub"), HasSubstr("a reference stands alone"));
  EXPECT_THAT(told_with("default: 0.3 m", "default: 300 m"),
              HasSubstr("its value 300 m does not fit, expected length, 0.01 m to 100 m"));
  EXPECT_THAT(
      told(cascade, {}),
      HasSubstr("a.yaml:5:3: parameter 'input': it has no default, and no value was given."));
  EXPECT_THAT(told_with("type: length", "type: lenght"), HasSubstr("Did you mean 'length'?"));
}

TEST(Mistakes, InYaml) {
  EXPECT_THAT(told("plumb: 1\nsteps: {a: [}\n"), HasSubstr("a.yaml:2:13: this is not YAML"));
  EXPECT_THAT(told_with("frames: 30", "frames: 30, frames: 40"),
              HasSubstr("a.yaml:9:83: 'frames' is written twice."));
  EXPECT_THAT(told_with("frames: 30", "<<: {frames: 30}"),
              HasSubstr("'<<' does not merge maps here"));
  EXPECT_THAT(told_with("frames: 30", "frames: !!int 30"), HasSubstr("the tag"));
  EXPECT_THAT(told_with("frames: 30", "[a]: 30"), HasSubstr("a key must be a plain word"));
  EXPECT_THAT(told_with("frames: 30", "frames: *x"), HasSubstr("a.yaml:9:"));
  EXPECT_THAT(told(cascade + "---\nplumb: 1\n"), HasSubstr("a second YAML document"));
  EXPECT_THAT(told(""), HasSubstr("a.yaml:1:1: the file is empty."));
  EXPECT_THAT(told("- a\n"), HasSubstr("expected a map with 'plumb: 1' and 'steps', found a list"));
  std::string bomb = "plumb: 1\na: &a [x, x, x, x, x, x, x, x, x]\n";
  for (char c = 'b'; c < 'k'; ++c) {
    const std::string use = std::string("*") + static_cast<char>(c - 1);
    bomb += std::string(1, c) + ": &" + c + " [" + use + ", " + use + ", " + use + ", " + use +
            ", " + use + ", " + use + ", " + use + "]\n";
  }
  EXPECT_THAT(told(bomb), HasSubstr("more than 20000 values once aliases are expanded"));
  EXPECT_THAT(told(std::string(5000, '[')), HasSubstr("a.yaml:1:"));
}

TEST(Mistakes, InYamlAreShownInTheLineThatIsToBlame) {
  const auto of = [](const std::string& steps) { return told("plumb: 1\nsteps:\n" + steps); };
  EXPECT_THAT(of("  a: {use: x\n  b: {use: y}\n"), HasSubstr("a.yaml:3:6: this is not YAML: the '{' is not closed."));
  EXPECT_THAT(of("  a: {use: x, from: [y\n  b: {use: y}\n"), HasSubstr("a.yaml:3:21: this is not YAML: the '[' is"));
  EXPECT_THAT(of("  a: {use: x, with: {b: 1}\n\n  # c\n  c: {use: y}\n"), HasSubstr("a.yaml:3:6: "));
  EXPECT_THAT(of("  a: {use: x\n"), HasSubstr("a.yaml:3:6: "));
  EXPECT_THAT(of("  a:\n    use: x\n    form\n\n    with: {b: 1}\n"), HasSubstr("a.yaml:5:5: this is not YAML: this line has no ':'."));
  EXPECT_THAT(told("plumb 1\nsteps:\n  a: {use: y}\n"), HasSubstr("a.yaml:1:1: this is not YAML: this line has no"));
  EXPECT_THAT(of("\ta: {use: x}\n"), HasSubstr("a.yaml:3:1: this is not YAML: a tab indents this line."));
  EXPECT_THAT(of("  a: use: x\n"), HasSubstr("a.yaml:3:9: this is not YAML: illegal map value."));  // not moved
}

TEST(Mistakes, InKeysAndNames) {
  EXPECT_THAT(told_with("from: segments}", "form: segments}"),
              HasSubstr("a.yaml:13:34: step 'fpfh': unknown key 'form'."));
  EXPECT_THAT(told_with("from: segments}", "form: segments}"), HasSubstr("Did you mean 'from'?"));
  EXPECT_THAT(told_with("at_most", "at_mots"), HasSubstr("Did you mean 'at_most'?"));
  EXPECT_THAT(told_with("plumb: 1", "plumb: 2"), HasSubstr("Write 'plumb: 1'."));
  EXPECT_THAT(told_with("plumb: 1\n", ""), HasSubstr("'plumb: 1' is missing"));
  EXPECT_THAT(told_with("use: describe.fpfh", "use: describe.fphf"),
              HasSubstr("a.yaml:13:19: step 'fpfh': no module offers 'describe.fphf'."));
  EXPECT_THAT(told_with("use: describe.fpfh", "use: describe.fphf"),
              HasSubstr("Did you mean 'describe.fpfh'?"));
  EXPECT_THAT(told_with("use: prune.kmeans", "use: kmeans"),
              HasSubstr("Did you mean 'prune.kmeans'?"));
  EXPECT_THAT(told_with("      matches:    {use", "      ranged:    {use"),
              HasSubstr("the name 'ranged' is taken by an outer one."));
  EXPECT_THAT(told_with("  fpfh: ", "  fp-fh: "), HasSubstr("'fp-fh' is no name"));
  EXPECT_THAT(told_with("steps:\n      neighbours", "setps:\n      neighbours"),
              HasSubstr("'drift' is neither a step"));
  EXPECT_THAT(told("plumb: 1\nsteps: {}\n"), HasSubstr("the pipeline has no steps"));
}

TEST(Mistakes, OfOneStepDoNotCauseMore) {
  const std::string all = told_with("use: describe.fpfh", "use: describe.fphf");
  EXPECT_EQ(std::count(all.begin(), all.end(), '^'), 1) << all;
}

TEST(Mistakes, OfOneWordAreToldOnce) {
  const auto once = [&](const std::string& old, const std::string& fresh) {
    const std::string all = told_with(old, fresh);
    EXPECT_EQ(std::count(all.begin(), all.end(), '^'), 1) << all;
    return all;
  };
  EXPECT_THAT(once("from: merged", "from: megred"), HasSubstr("Did you mean 'merged'?"));
  EXPECT_THAT(once("from: merged", "form: merged"), HasSubstr("Did you mean 'from'?"));
  EXPECT_THAT(once("{use: describe.fpfh", "{ues: describe.fpfh"), HasSubstr("Did you mean 'use'?"));
  EXPECT_THAT(once("with: {path: $input}", "wiht: {path: $input}"), HasSubstr("Did you mean 'with'?"));
  EXPECT_THAT(once("leaf: $voxel", "leaf: $voxle"), HasSubstr("Did you mean 'voxel'?"));
  EXPECT_THAT(once("max: $gate", "max: $gaet"), HasSubstr("nothing is called '$gaet'"));
  EXPECT_THAT(once("from: segments}", "from: descriptors}"), HasSubstr("nothing here is called"));
}

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
              HasSubstr("its input 'ranges' is not wired, it wants Range, one per segment."));
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
  const std::string more = cascade + "  extra: {use: measure.match_rmse, from: ranges.poses}\n";
  EXPECT_THAT(told(more), HasSubstr("'ranges.poses' fits in more than one way."));
  EXPECT_THAT(told(more), HasSubstr("{poses: ranges.poses} or {pairs: ranges.poses}"));
}

TEST(Mistakes, InGrains) {
  // An EdgeStep sees one edge's matches; the solver sees all of them.
  EXPECT_THAT(
      told_with("matches: kept, poses: poses}, with: {loss",
                "matches: edges, poses: poses}, with: {loss"),
      HasSubstr("its input 'matches' wants Matches, one per edge, but 'edges' gives Edges."));
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

TEST(Mistakes, OfNamingFilesThatAreNotThere) {
  const test::Folder folder;
  folder.write("street/odometry.tum", "");
  const std::string place = folder.path().string();
  const auto told_for = [&](const std::string& value, bool in_file, bool needs_files = true) {
    Overlay overlay;
    overlay.needs_files = needs_files;
    if (!in_file) overlay.sets = {"input=" + value};
    const std::string given = in_file ? "{type: path, default: " + value : "{type: path";
    try {
      read_pipeline(folder.write("a.yaml", with("{type: path", given)), overlay, test::registry());
    } catch (const PipelineError& error) {
      EXPECT_EQ(error.diagnostics().size(), 1u);
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(told_for("street", true), "");
  EXPECT_EQ(told_for(place + "/street", false), "");
  EXPECT_EQ(told_for("nowhere", true, false), "");  // what only looks at the wires needs no data
  const std::string in_file = told_for("stret", true);
  EXPECT_THAT(in_file, HasSubstr("a.yaml:5:32: step 'sequence' (source.sequence): parameter 'path': "
                                 "there is no file or folder '" + place + "/stret'."));
  EXPECT_THAT(in_file, HasSubstr("Did you mean '" + place + "/street'?"));
  const std::string in_set = told_for(place + "/far/away", false);
  EXPECT_THAT(in_set, HasSubstr("--set input=" + place + "/far/away: step 'sequence'"));
  EXPECT_THAT(in_set, HasSubstr("There is no folder '" + place + "/far' either."));
  EXPECT_THAT(in_set, HasSubstr("Asked for at " + place + "/a.yaml:8:3."));
}

TEST(Mistakes, OfFilesThatAreNotThere) {
  try {
    read_pipeline("no/such.yaml", {}, test::registry());
    FAIL();
  } catch (const PipelineError& error) {
    EXPECT_THAT(error.what(), HasSubstr("there is no file 'no/such.yaml'."));
  }
}

TEST(Mistakes, OfTakingSomethingElseForAPipeline) {
  EXPECT_THAT(told("# .PCD v0.7\nVERSION 0.7\n"), HasSubstr("a.yaml' is a point cloud (PCD), not a pipeline."));
  EXPECT_THAT(told("{\n  \"$schema\": \"x\"}"), HasSubstr("a.yaml' is a JSON Schema, not a pipeline."));
  EXPECT_THAT(told("# A run of Plumb: what made the files beside this one.\nplumb: 0.1\n"),
              HasSubstr("a.yaml' is the record of a run, not a pipeline."));
  EXPECT_THAT(told("1 2 3 4 0 0 0 1\n"), HasSubstr("is a trajectory (TUM), not a pipeline.\n  Give the YAML file"));
  const test::Folder folder;
  folder.write("pipelines/city.yaml", cascade);
  const auto told_of = [&](const std::string& name) {
    try {
      read_pipeline(folder.path() / name, {}, test::registry());
    } catch (const PipelineError& error) {
      EXPECT_EQ(error.diagnostics().size(), 1u);
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_THAT(told_of("pipelines"), HasSubstr("pipelines' is a folder, not a pipeline.\n  In it: "));
  EXPECT_THAT(told_of("pipelines/ctiy.yaml"), HasSubstr("Did you mean '" + (folder.path() / "pipelines/city.yaml").string()));
  EXPECT_THAT(told_of("pipelines/city"), HasSubstr("/pipelines/city.yaml'?"));
}

TEST(Mistakes, NeverCrashTheReader) {
  const test::Folder folder;
  std::uint64_t state = 1;
  const auto random = [&](std::size_t n) {
    state = state * 6364136223846793005u + 1442695040888963407u;
    return static_cast<std::size_t>((state >> 33) % n);
  };
  const auto survives = [&](const std::string& text) {
    try {
      read_pipeline(folder.write("f.yaml", text), {{}, {"input=data"}, false}, test::registry());
    } catch (const PipelineError& error) {
      EXPECT_FALSE(error.diagnostics().empty());
    }
  };
  for (std::size_t length = 0; length < cascade.size(); length += 23)
    survives(cascade.substr(0, length));
  for (int k = 0; k < 200; ++k) {
    std::string text = cascade;
    for (std::size_t flips = 1 + random(3); flips > 0; --flips)
      text[random(text.size())] = static_cast<char>(random(256));
    survives(text);
  }
  for (int k = 0; k < 100; ++k) {  // pieces moved elsewhere
    std::string text = cascade;
    const std::string piece = text.substr(random(text.size()), 1 + random(60));
    survives(text.insert(random(text.size()), piece));
  }
}

}  // namespace
}  // namespace plumb
