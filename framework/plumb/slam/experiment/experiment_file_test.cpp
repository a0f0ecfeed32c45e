#include <gmock/gmock.h>

#include "plumb/data/io/file_testing.hpp"
#include "plumb/slam/experiment/experiment.hpp"

namespace plumb::experiment {
namespace {

using io::TestFolder;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr const char* pipeline_text = "plumb: 1\nname: chained\nsteps: {}\n";

/// The experiment that a text is, beside the pipeline chained.yaml, its preset loose.yaml and
/// another pipeline, judge.yaml.
struct ExperimentFile : testing::Test {
  TestFolder folder;
  ExperimentFile() {
    folder.write("chained.yaml", pipeline_text);
    folder.write("judge.yaml", pipeline_text);
    folder.write("presets/loose.yaml", "plumb: 1\nextends: ../chained.yaml\n");
  }
  Experiment read(const std::string& text) const {
    folder.write("e.yaml", text);
    return read_experiment(folder.path() / "e.yaml");
  }
  /// What is told of it, with the folder cut off.
  std::string told(const std::string& text) const {
    try {
      read(text);
    } catch (const PipelineError& error) {
      std::string all = error.what();
      const std::string prefix = folder.path().string() + "/";
      for (auto at = all.find(prefix); at != std::string::npos; at = all.find(prefix))
        all.erase(at, prefix.size());
      return all;
    }
    return "";
  }
};

constexpr const char* least = "experiment: 1\npipeline: chained.yaml\nprimary: error.fine.ate\n";

TEST_F(ExperimentFile, OfThreeLinesIsAPipelineAndWhatDecides) {
  const Experiment made = read(least);
  EXPECT_EQ(made.name, "e");
  EXPECT_EQ(made.pipeline, folder.path() / "chained.yaml");
  EXPECT_EQ(made.primary, "error.fine.ate");
  EXPECT_EQ(made.margin, 0.05);
  EXPECT_EQ(made.replicates.count, 1u);
  EXPECT_TRUE(made.replicates.disturb_nothing());
  EXPECT_THAT(made.variants, IsEmpty());
  EXPECT_THAT(made.inputs, IsEmpty());
}

TEST_F(ExperimentFile, NamesVariantsByFileAndByWhatTheyChange) {
  const Experiment made =
      read(std::string(least) +
           "set: {truth: t.tum}\n"
           "variants:\n"
           "  loose: presets/loose.yaml\n"
           "  judged: judge.yaml\n"
           "  coarse: {set: {voxel_size: 0.5 m}}\n"
           "  both: {file: presets/loose.yaml, set: {voxel_size: 1 m}, remove: [map]}\n"
           "  same: {}\n");
  ASSERT_EQ(made.variants.size(), 5u);
  EXPECT_THAT(made.variants[0].presets, ElementsAre(folder.path() / "presets/loose.yaml"));
  EXPECT_FALSE(made.variants[0].alone());
  EXPECT_EQ(made.variants[1].pipeline, folder.path() / "judge.yaml");
  EXPECT_TRUE(made.variants[1].alone());
  ASSERT_EQ(made.variants[2].edits.size(), 1u);
  EXPECT_EQ(made.variants[2].edits[0].tree.at("set")->at("voxel_size")->text, "0.5 m");
  EXPECT_EQ(made.variants[2].edits[0].tree.at("set")->at("voxel_size")->origin.line, 8);
  EXPECT_THAT(made.variants[3].edits[0].tree.keys(), ElementsAre("set", "remove"));
  EXPECT_THAT(made.variants[4].edits, IsEmpty());
  EXPECT_THAT(made.edits[0].tree.at("set")->keys(), ElementsAre("truth"));
}

TEST_F(ExperimentFile, NamesInputsByWhereTheyLie) {
  const Experiment made = read(std::string(least) +
                               "inputs:\n"
                               "  - data/street\n"
                               "  - other/street/\n"
                               "  - {path: ../mall, name: shops, set: {truth: ../mall.tum}}\n");
  ASSERT_EQ(made.inputs.size(), 3u);
  EXPECT_EQ(made.inputs[0].path, folder.path() / "data/street");
  EXPECT_EQ(made.inputs[0].name, "street");
  EXPECT_EQ(made.inputs[1].name, "street_2");
  EXPECT_EQ(made.inputs[2].name, "shops");
  EXPECT_EQ(made.inputs[2].edits[0].tree.at("set")->keys(), std::vector<std::string>{"truth"});
  EXPECT_THAT(made.inputs[2].where, HasSubstr("e.yaml:7:5: input '../mall'"));
}

TEST_F(ExperimentFile, SaysWhatReplicatesDisturb) {
  const auto of = [&](const std::string& text) {
    return read(std::string(least) + "replicates: " + text + "\n").replicates;
  };
  EXPECT_EQ(of("4").count, 4u);
  EXPECT_TRUE(of("4").phase && of("4").seeds && of("4").skip_frames > 0 && of("4").drop_frames > 0);
  const Replicates some = of("{count: 3, seed: 7, drop_frames: 2 %, phase: true}");
  EXPECT_EQ(some.count, 3u);
  EXPECT_EQ(some.seed, 7u);
  EXPECT_EQ(some.drop_frames, 0.02);
  EXPECT_EQ(some.skip_frames, 0u);
  EXPECT_TRUE(some.phase);
  EXPECT_FALSE(some.seeds);
  EXPECT_TRUE(of("{count: 3, seed: 7}").seeds);
}

TEST_F(ExperimentFile, TakesSweepsMarginAndMetrics) {
  const Experiment made =
      read(std::string(least) +
           "margin: 3 %\n"
           "metrics: ['error.*', loops.kept]\n"
           "higher_is_better: loops.kept\n"
           "time: [match.]\n"
           "sweep: {voxel_size: [0.2 m, 0.3 m], coarse.gate: [[3 m, 1 m], 2 m]}\n"
           "sweep_by: one_at_a_time\n");
  EXPECT_EQ(made.margin, 0.03);
  EXPECT_THAT(made.metrics, ElementsAre("error.*", "loops.kept"));
  EXPECT_THAT(made.higher_is_better, ElementsAre("loops.kept"));
  EXPECT_THAT(made.timed, ElementsAre("match."));
  EXPECT_EQ(made.timed_where, (folder.path() / "e.yaml").string() + ":7:7: 'time'");
  EXPECT_EQ(made.sweep_by, SweepBy::one_at_a_time);
  ASSERT_EQ(made.axes.size(), 2u);
  EXPECT_EQ(made.axes[1].name, "coarse.gate");
  EXPECT_TRUE(made.axes[1].values[0].is_list());
}

TEST_F(ExperimentFile, TellsEveryMistakeWithItsPlace) {
  const std::string all = told(
      "experiment: 2\n"
      "pipeline: chained.yaml\n"
      "variant: {}\n"
      "margin: 5\n"
      "sweep_by: gird\n"
      "variants:\n"
      "  ../up: judge.yaml\n"
      "  odd: {sets: {a: 1}}\n"
      "inputs: {a: b}\n"
      "replicates: {count: 0, phase: perhaps}\n"
      "sweep: {voxel_size: 0.2 m}\n");
  EXPECT_THAT(all, HasSubstr("e.yaml:1:13: expected 'experiment: 1'"));
  EXPECT_THAT(all, HasSubstr("e.yaml:1:1: 'primary' is missing"));
  EXPECT_THAT(all,
              HasSubstr("e.yaml:3:1: an experiment has no key 'variant'.\n  3 | variant: {}\n"));
  EXPECT_THAT(all, HasSubstr("Did you mean 'variants'?"));
  EXPECT_THAT(all, HasSubstr("e.yaml:4:9: 'margin': '5' has no unit, expected a ratio"));
  EXPECT_THAT(all, HasSubstr("e.yaml:5:11: 'sweep_by': 'gird' is not one of the choices"));
  EXPECT_THAT(all, HasSubstr("e.yaml:7:3: variant '../up' is not a name for a file or folder"));
  EXPECT_THAT(all, HasSubstr("e.yaml:8:9: variant 'odd' has no key 'sets'."));
  EXPECT_THAT(all, HasSubstr("e.yaml:9:9: 'inputs' is a list, found a map."));
  EXPECT_THAT(all, HasSubstr("e.yaml:10:21: 'count' of the replicates: '0' is out of range"));
  EXPECT_THAT(all, HasSubstr("e.yaml:10:31: 'phase': 'perhaps' is not a boolean"));
  EXPECT_THAT(all, HasSubstr("e.yaml:11:21: a sweep of 'voxel_size' takes a list of values"));
}

TEST_F(ExperimentFile, RefusesReplicatesThatAreOneRunAgainAndAgain) {
  EXPECT_THAT(told(std::string(least) + "replicates: {count: 3, phase: false}\n"),
              HasSubstr("e.yaml:4:13: replicates that disturb nothing"));
}

TEST_F(ExperimentFile, RefusesTwoInputsOfOneName) {
  EXPECT_THAT(told(std::string(least) + "inputs: [{path: a, name: x}, {path: b, name: x}]\n"),
              HasSubstr("there is an input 'x' already.\n"));
}

TEST_F(ExperimentFile, SweepsOverWhatCanBeSetAlone) {
  const auto of = [&](const std::string& values) {
    return told(std::string(least) + "sweep: {gate: [" + values + "]}\n");
  };
  EXPECT_EQ(of("1 m, [1 m, 2 m]"), "");
  for (const char* odd : {"{a: 1}", "[]", "[[1 m]]", "~"})
    EXPECT_THAT(of(odd), HasSubstr("e.yaml:4:16: a value of 'gate' is expected")) << odd;
}

TEST_F(ExperimentFile, ThatIsNoYamlIsToldSo) {
  EXPECT_THAT(told("experiment: 1\nvariants: {a: [\n"), HasSubstr("this is not YAML"));
}

}  // namespace
}  // namespace plumb::experiment
