/// Presets and --set.
#include <gmock/gmock.h>

#include "plumb/pipeline/print/table.hpp"
#include "plumb/pipeline/testing/test_steps.hpp"

namespace plumb {
namespace {

using test::cascade;
using testing::HasSubstr;

class Overlays : public testing::Test {
 protected:
  Overlays() { file_ = folder_.write("cascade.yaml", cascade); }
  Plan read(const std::vector<std::string>& sets,
            const std::vector<std::string>& presets = {}) const {
    Overlay overlay;
    overlay.sets = sets;
    overlay.sets.push_back("input=data");
    for (const std::string& preset : presets) overlay.presets.push_back(folder_.path() / preset);
    return read_pipeline(file_, overlay, test::registry());
  }
  std::string told(const std::vector<std::string>& sets,
                   const std::vector<std::string>& presets = {}) const {
    try {
      read(sets, presets);
    } catch (const PipelineError& error) {
      return error.what();
    }
    return "";
  }
  static const PlannedStep* step(const Plan& plan, const std::string& path) {
    for (const PlannedStep& s : plan.steps)
      if (s.path == path) return &s;
    return nullptr;
  }
  static ParameterValue value(const Plan& plan, const std::string& path, const std::string& name) {
    const PlannedStep& s = *step(plan, path);
    return s.parameters[s.description->parameter(name) - s.description->parameters.data()].value;
  }

  test::Folder folder_;
  std::filesystem::path file_;
};

TEST_F(Overlays, SetParametersRowsAndStepsOnTheCommandLine) {
  const Plan plan =
      read({"voxel=0.2m", "coarse.gate=2m,1m", "coarse.kept.clusters=4", "coarse.at_most=9"});
  EXPECT_EQ(value(plan, "segments", "leaf"), ParameterValue(0.2));
  EXPECT_EQ(plan.repeats[0].rows[0].values, (std::vector<ParameterValue>{2.0, 1.0}));
  EXPECT_EQ(plan.repeats[0].passes, 2);
  EXPECT_EQ(plan.repeats[0].at_most, 9);
  EXPECT_EQ(value(plan, "coarse.kept", "clusters"), ParameterValue(std::int64_t{4}));
}

TEST_F(Overlays, SetWhatARowOrAParameterOfThePipelineFeeds) {
  const Plan plan = read({"coarse.near.max=3m", "segments.leaf=0.2m"});
  EXPECT_EQ(value(plan, "coarse.near", "max"), ParameterValue(3.0));
  EXPECT_EQ(plan.repeats[0].passes, 3) << "the row says how many, still";
  EXPECT_EQ(value(plan, "segments", "leaf"), ParameterValue(0.2));
  EXPECT_THAT(plan.resolved, HasSubstr("# nothing uses it any more"));
  EXPECT_THAT(plan.resolved, HasSubstr(", nothing uses it any more"));
  EXPECT_THAT(
      passes_table(plan),
      HasSubstr("  pass\n     1\n     2\n     3\n   4-6\n  (no step uses the row 'gate' any "
                "more: "));
  std::string text = plan.resolved;  // in which paths must lead somewhere
  const std::string data = std::filesystem::absolute("data").string();
  text.replace(text.find(data), data.size(), folder_.path().string());
  const Plan again = read_resolved(text, "resolved", test::registry());
  EXPECT_EQ(value(again, "segments", "leaf"), ParameterValue(0.2));
}

TEST_F(Overlays, LeaveParametersAndRowsOfTheBaseWithoutAUse) {
  folder_.write("p.yaml",
                "plumb: 1\nextends: cascade.yaml\nset: {segments.leaf: 1 m, coarse.near.max: 2 "
                "m}\n");
  EXPECT_EQ(value(read({}, {"p.yaml"}), "segments", "leaf"), ParameterValue(1.0));
  EXPECT_THAT(read({"voxel=2m"}, {"p.yaml"}).warnings,
              testing::ElementsAre(HasSubstr(
                  "--set voxel=2m: warning: nothing uses the parameter 'voxel' any more, so that "
                  "this sets nothing;")));
  EXPECT_THAT(read({"coarse.gate=2m"}, {"p.yaml"}).warnings,
              testing::ElementsAre(HasSubstr(
                  "--set coarse.gate=2m: warning: nothing uses the row 'coarse.gate' any more")));
  EXPECT_THAT(read({}, {"p.yaml"}).warnings, testing::IsEmpty());
  folder_.write("base.yaml",
                std::string(cascade).replace(std::string(cascade).find("parameters:"), 11,
                                             "parameters:\n  spare: {type: "
                                             "length, default: 1 m}"));
  folder_.write("q.yaml", "plumb: 1\nextends: base.yaml\nset: {segments.leaf: 1 m}\n");
  try {
    read_pipeline(folder_.path() / "q.yaml", {{}, {"input=data"}, false}, test::registry());
    FAIL() << "what nothing ever used is the base's own mistake";
  } catch (const PipelineError& error) {
    EXPECT_THAT(error.what(), HasSubstr("base.yaml:"));
    EXPECT_THAT(error.what(), HasSubstr("nothing uses the parameter 'spare'."));
    EXPECT_EQ(error.diagnostics().size(), 1u);
  }
}

TEST_F(Overlays, RemoveParametersRowsAndWhatAStepIsGiven) {
  folder_.write("p.yaml",
                "plumb: 1\nextends: cascade.yaml\nremove: [coarse.near.max, coarse.gate, "
                "segments.leaf, voxel]\nset: {coarse.at_most: 2}\n");
  const std::string all = told({}, {"p.yaml"});
  EXPECT_THAT(all, Not(HasSubstr("cannot be removed")));
  EXPECT_THAT(all, Not(HasSubstr("there is no")));
  folder_.write("q.yaml", "plumb: 1\nextends: cascade.yaml\nremove: [ranges.frames]\n");
  EXPECT_EQ(value(read({}, {"q.yaml"}), "ranges", "frames"),
            step(read({}), "ranges")->description->parameter("frames")->standard);
  folder_.write("r.yaml",
                "plumb: 1\nextends: cascade.yaml\nremove: [voxle, coarse.gaet, ranges.fraems]\n");
  EXPECT_THAT(told({}, {"r.yaml"}), HasSubstr("r.yaml:3:10: 'voxle': there is no 'voxle' in the "
                                              "pipeline.\n"));
  EXPECT_THAT(told({}, {"r.yaml"}), HasSubstr("Did you mean 'voxel'?"));
  EXPECT_THAT(told({}, {"r.yaml"}),
              HasSubstr("'ranges.fraems' cannot be removed: the step is not given 'fraems'."));
}

TEST_F(Overlays, NameWhatCannotBeSet) {
  EXPECT_THAT(
      told({"voxle=1m"}),
      HasSubstr("--set voxle=1m: the pipeline has no parameter 'voxle'.\n  Did you mean 'voxel'?"));
  EXPECT_THAT(told({"coarse.gaet=1m"}), HasSubstr("Did you mean 'gate'?"));
  EXPECT_THAT(told({"coarse.kpet.clusters=1"}),
              HasSubstr("there is no 'kpet' in 'coarse'.\n  Did you mean 'kept'?"));
  EXPECT_THAT(told({"coarse.kept.clutsers=1"}),
              HasSubstr("--set coarse.kept.clutsers=1: step 'coarse.kept' (prune.kmeans): unknown "
                        "parameter 'clutsers'."));
  EXPECT_THAT(told({"coarse.kept=1"}), HasSubstr("--set coarse.kept=1: "));
  EXPECT_THAT(told({"voxel"}), HasSubstr("expected NAME=VALUE."));
  EXPECT_THAT(told({"voxel=1"}), HasSubstr("--set voxel=1: parameter 'voxel': '1' has no unit"));
  EXPECT_THAT(told({"voxel=1"}),
              HasSubstr("'1' has no unit, expected a length.\n"));  // not: or none
  EXPECT_THAT(told({"voxel=1m", "voxel=2m"}), HasSubstr("'voxel' is set twice"));
}

TEST_F(Overlays, EditsOfAnotherFileAreLaidOverBeforeWhatTheCommandLineSets) {
  const auto text = std::make_shared<const std::string>(
      "variants:\n  fine: {set: {voxel: 0.1 m, coarse.gate: [2 m, 1 m]}}\n  bad: {set: {voxle: 1 "
      "m}}\n");
  pipeline::Diagnostics none;
  const auto tree = pipeline::parse_yaml(*text, "street/experiment.yaml", none);
  ASSERT_TRUE(tree);
  Overlay overlay;
  overlay.sets = {"input=data"};
  overlay.edits = {Edits{*tree->at("variants")->at("fine"), text}};
  const Plan plan = read_pipeline(file_, overlay, test::registry());
  EXPECT_EQ(value(plan, "segments", "leaf"), ParameterValue(0.1));
  EXPECT_EQ(plan.repeats[0].passes, 2);
  overlay.sets.push_back("voxel=0.2m");
  EXPECT_EQ(value(read_pipeline(file_, overlay, test::registry()), "segments", "leaf"),
            ParameterValue(0.2));
  overlay.edits = {Edits{*tree->at("variants")->at("bad"), text}};
  try {
    read_pipeline(file_, overlay, test::registry());
    FAIL() << "not refused";
  } catch (const PipelineError& error) {
    EXPECT_THAT(error.what(), HasSubstr("street/experiment.yaml:3:15: the pipeline has no "
                                        "parameter 'voxle'.\n  3 |   bad: {set: {voxle: 1 m}}\n"));
    EXPECT_THAT(error.what(), HasSubstr("Did you mean 'voxel'?"));
  }
}

constexpr const char* preset = R"(plumb: 1
name: ransac
extends: ../cascade.yaml
set:
  voxel: 0.25 m
  coarse.gate: [3 m, 1.5 m, 0.8 m, 0.4 m]
replace:
  coarse.kept: {use: prune.ransac, from: near, with: {inlier: 0.4 m}}
)";

TEST_F(Overlays, ChangeTheScheduleAndSwapAStepInYamlAlone) {
  folder_.write("presets/ransac.yaml", preset);
  for (const bool stacked : {false, true}) {
    const Plan plan = stacked ? read({}, {"presets/ransac.yaml"})
                              : read_pipeline(folder_.path() / "presets/ransac.yaml",
                                              {{}, {"input=data"}, false}, test::registry());
    EXPECT_EQ(plan.name, "ransac");
    EXPECT_EQ(plan.repeats[0].passes, 4);
    EXPECT_EQ(step(plan, "coarse.kept")->description->name, "prune.ransac");
    EXPECT_EQ(value(plan, "coarse.kept", "inlier"), ParameterValue(0.4));
    EXPECT_EQ(value(plan, "segments", "leaf"), ParameterValue(0.25));
    EXPECT_EQ(plan.files.size(), 2u);
    EXPECT_THAT(plan.resolved, HasSubstr("presets/ransac.yaml:8:"));
  }
  EXPECT_EQ(value(read({"voxel=0.5m"}, {"presets/ransac.yaml"}), "segments", "leaf"),
            ParameterValue(0.5));  // --set comes last
}

TEST_F(Overlays, DropAndAddStages) {
  folder_.write("p.yaml", R"(plumb: 1
extends: cascade.yaml
remove: [coarse]
add:
  again: {use: solve.pose_graph, from: {poses: drift.solved}}
replace:
  edges: {use: edges.overlap, from: {segments: segments, poses: again}}
  drift.matches: {use: match.fpfh_mutual, from: {edges: neighbours, features: fpfh}}
)");
  EXPECT_THAT(told({}, {"p.yaml"}),
              HasSubstr("p.yaml:7:3: step 'edges' (edges.overlap): nothing uses what it makes."));
  folder_.write("q.yaml",
                "plumb: 1\nextends: cascade.yaml\nremove: [coarse, edges]\nadd:\n  again: {use: "
                "solve.pose_graph, from: {poses: drift.solved}}\n");
  const Plan plan = read({}, {"q.yaml"});
  EXPECT_TRUE(plan.repeats.empty());
  EXPECT_NE(step(plan, "again"), nullptr);
  EXPECT_EQ(step(plan, "coarse.kept"), nullptr);
}

TEST_F(Overlays, StackInOrder) {
  folder_.write("one.yaml", "plumb: 1\nextends: cascade.yaml\nset: {voxel: 1 m}\n");
  folder_.write("two.yaml", "plumb: 1\nextends: one.yaml\nset: {ranges.frames: 7}\n");
  folder_.write("three.yaml", "plumb: 1\nextends: cascade.yaml\nset: {voxel: 3 m}\n");
  const Plan plan = read({}, {"two.yaml", "three.yaml"});
  EXPECT_EQ(value(plan, "segments", "leaf"), ParameterValue(3.0));
  EXPECT_EQ(value(plan, "ranges", "frames"), ParameterValue(std::int64_t{7}));
  EXPECT_EQ(plan.files.size(), 4u);
}

TEST_F(Overlays, AreRefusedWhereTheyDoNotFit) {
  folder_.write("other.yaml", cascade);
  folder_.write("a.yaml", "plumb: 1\nextends: other.yaml\nset: {voxel: 1 m}\n");
  EXPECT_THAT(told({}, {"a.yaml"}), HasSubstr("a.yaml:2:10: this preset extends '"));
  EXPECT_THAT(told({}, {"other.yaml"}),
              HasSubstr("a preset extends a pipeline, and this file extends none."));
  EXPECT_THAT(told({}, {"other.yaml"}), HasSubstr("Write 'extends: cascade.yaml', or run"));
  EXPECT_THAT(told({}, {"none.yaml"}), HasSubstr("there is no file"));
  folder_.write("lone.yaml", "plumb: 1\nset: {voxel: 1 m}\n");
  try {
    read_pipeline(folder_.path() / "lone.yaml", {}, test::registry());
    FAIL();
  } catch (const PipelineError& error) {
    EXPECT_THAT(
        error.what(),
        HasSubstr("lone.yaml:2:1: 'set' changes a pipeline, and this file does not say which."));
    EXPECT_THAT(error.what(), HasSubstr("Add 'extends: PIPELINE.yaml'"));
    EXPECT_EQ(error.diagnostics().size(), 1u);
  }
  folder_.write("b.yaml",
                "plumb: 1\nextends: cascade.yaml\nste: {voxel: 1 m}\nremove: [coarse.kpet]\nadd: "
                "{edges: {use: x}}\nreplace: {edgse: {use: x}}\n");
  const std::string all = told({}, {"b.yaml"});
  EXPECT_THAT(all, HasSubstr("b.yaml:3:1: an overlay has no key 'ste'.\n"));
  EXPECT_THAT(all, HasSubstr("b.yaml:4:10: 'coarse.kpet': there is no 'kpet' in 'coarse'."));
  EXPECT_THAT(all, HasSubstr("b.yaml:5:7: 'edges' is there already"));
  EXPECT_THAT(all, HasSubstr("Did you mean 'edges'?"));
  folder_.write("self.yaml", "plumb: 1\nextends: self.yaml\n");
  EXPECT_THAT(told({}, {"self.yaml"}), HasSubstr("extends itself"));
}

/// A preset of other.yaml with `edits` for cascade.yaml.
std::string serving_both(const std::string& edits) {
  return "plumb: 1\nname: both\nextends: ../other.yaml\nset: {voxel: 1 m}\nalso:\n  "
         "../cascade.yaml: " +
         edits + "\n";
}

TEST_F(Overlays, AreLaidOverAnotherPipelineByWhatTheyNameUnderAlso) {
  folder_.write("other.yaml", cascade);
  folder_.write("presets/both.yaml",
                serving_both("{name: mine, set: {ranges.frames: 7}, replace: {coarse.kept: {use: "
                             "prune.ransac, from: near}}}"));
  const Plan plan = read({}, {"presets/both.yaml"});
  EXPECT_EQ(plan.name, "mine");
  EXPECT_EQ(value(plan, "ranges", "frames"), ParameterValue(std::int64_t{7}));
  EXPECT_EQ(step(plan, "coarse.kept")->description->name, "prune.ransac");
  EXPECT_EQ(value(plan, "segments", "leaf"), ParameterValue(0.3))
      << "what it sets in other.yaml is not set here";
  EXPECT_EQ(plan.files.size(), 2u);
  const Plan own = read_pipeline(folder_.path() / "presets/both.yaml", {{}, {"input=data"}, false},
                                 test::registry());
  EXPECT_EQ(own.name, "both");
  EXPECT_EQ(value(own, "segments", "leaf"), ParameterValue(1.0));
  EXPECT_EQ(value(own, "ranges", "frames"), ParameterValue(std::int64_t{30}));
  EXPECT_EQ(value(read({"ranges.frames=9"}, {"presets/both.yaml"}), "ranges", "frames"),
            ParameterValue(std::int64_t{9}));
}

TEST_F(Overlays, NameWhatCannotStandUnderAlsoWhicheverPipelineTheyAreLaidOver) {
  folder_.write("other.yaml", cascade);
  folder_.write("presets/p.yaml", serving_both("{ste: {voxel: 2 m}}"));
  folder_.write("presets/q.yaml", serving_both("voxel"));
  const auto alone = [&](const char* name) -> std::string {
    try {
      read_pipeline(folder_.path() / name, {{}, {"input=data"}, false}, test::registry());
    } catch (const PipelineError& error) {
      return error.what();
    }
    return "";
  };
  for (const std::string& told_of_p : {told({}, {"presets/p.yaml"}), alone("presets/p.yaml")})
    EXPECT_THAT(
        told_of_p,
        testing::AllOf(
            HasSubstr("p.yaml:6:21: what stands under a pipeline of 'also' has no key 'ste'."),
            HasSubstr("Did you mean 'set'?")));
  for (const std::string& told_of_q : {told({}, {"presets/q.yaml"}), alone("presets/q.yaml")})
    EXPECT_THAT(told_of_q,
                HasSubstr("q.yaml:6:20: 'also' takes a map of edits for each pipeline, found "));
  folder_.write("presets/r.yaml", serving_both("{set: {voxle: 2 m}}"));
  EXPECT_THAT(told({}, {"presets/r.yaml"}),
              HasSubstr("r.yaml:6:27: the pipeline has no parameter 'voxle'."));
  folder_.write("s.yaml", "plumb: 1\nextends: cascade.yaml\nalso: voxel\n");
  EXPECT_THAT(told({}, {"s.yaml"}), HasSubstr("s.yaml:3:7: 'also'"));
}

TEST_F(Overlays, AreRefusedOverAPipelineThatTheyNeitherExtendNorNameUnderAlso) {
  folder_.write("other.yaml", cascade);
  folder_.write("third.yaml", cascade);
  folder_.write("a.yaml", "plumb: 1\nextends: other.yaml\nset: {voxel: 1 m}\n");
  folder_.write("b.yaml",
                "plumb: 1\nextends: other.yaml\nalso: {third.yaml: {set: {voxel: 1 m}}}\n");
  for (const char* name : {"a.yaml", "b.yaml"}) {
    const std::string text = told({}, {name});
    EXPECT_THAT(text, HasSubstr(std::string(name) + ":2:10: this preset extends '"));
    EXPECT_THAT(
        text,
        HasSubstr("Run it by itself, or name the edits for that pipeline in it under 'also'."));
  }
}

TEST_F(Overlays, OfAChainOfPresetsAreAllLaidOverByWhatEachNamesUnderAlso) {
  folder_.write("other.yaml", cascade);
  folder_.write("one.yaml",
                "plumb: 1\nextends: other.yaml\nalso: {cascade.yaml: {set: {voxel: 1 m, "
                "ranges.frames: 7}}}\n");
  folder_.write("two.yaml",
                "plumb: 1\nextends: one.yaml\nalso: {cascade.yaml: {set: {voxel: 2 m}}}\n");
  const Plan plan = read({}, {"two.yaml"});
  EXPECT_EQ(value(plan, "segments", "leaf"), ParameterValue(2.0));
  EXPECT_EQ(value(plan, "ranges", "frames"), ParameterValue(std::int64_t{7}));
}

TEST_F(Overlays, AreFoundByTheirNameBesideThePipeline) {
  const auto car =
      folder_.write("presets/car.yaml", "plumb: 1\nextends: ../cascade.yaml\nset: {voxel: 1 m}\n");
  for (const char* name : {"car", "cra", "car.yaml", "else/car.yaml"})
    EXPECT_THAT(told({}, {name}), HasSubstr("Did you mean '" + car.string() + "'?"));
}

TEST_F(Overlays, ShowThePassesAsATable) {
  const std::string table = passes_table(read({}));
  EXPECT_EQ(table,
            "coarse: 2 to 6 passes, until rmse falls by less than 2 %\n"
            "  pass  gate\n"
            "     1   4 m\n"
            "     2   2 m\n"
            "     3   1 m\n"
            "   4-6   1 m\n");
}

}  // namespace
}  // namespace plumb
