#include "plumb/pipeline/reader.hpp"

#include <gmock/gmock.h>

#include "plumb/pipeline/testing/test_steps.hpp"

namespace plumb {
namespace {

using test::cascade;
using test::Folder;
using test::registry;
using testing::ElementsAre;
using testing::HasSubstr;

Plan plan_of(const std::string& text, std::vector<std::string> sets = {"input=data"}) {
  const Folder folder;
  Overlay overlay;
  overlay.sets = std::move(sets);
  return read_pipeline(folder.write("a.yaml", text), overlay, registry());
}

const PlannedStep& step(const Plan& plan, const std::string& path) {
  for (const PlannedStep& s : plan.steps)
    if (s.path == path) return s;
  throw std::runtime_error("no step " + path);
}
int index_of(const Plan& plan, const std::string& path) {
  return static_cast<int>(&step(plan, path) - plan.steps.data());
}
const PlannedParameter& parameter(const Plan& plan, const std::string& path,
                                  const std::string& name) {
  const PlannedStep& s = step(plan, path);
  return s.parameters[s.description->parameter(name) - s.description->parameters.data()];
}
const std::vector<Wire>& input(const Plan& plan, const std::string& path, const std::string& name) {
  const PlannedStep& s = step(plan, path);
  return s.inputs[s.description->input(name) - s.description->inputs.data()];
}
std::vector<std::string> names(const Plan& plan, const std::vector<PlannedItem>& items) {
  std::vector<std::string> all;
  for (const PlannedItem& item : items)
    all.push_back(item.step >= 0 ? plan.steps[item.step].path : plan.repeats[item.repeat].path);
  return all;
}

TEST(Reader, ReadsAWholeCascade) {
  const Plan plan = plan_of(cascade);
  EXPECT_EQ(plan.name, "cascade");
  EXPECT_EQ(plan.steps.size(), 16u);
  ASSERT_EQ(plan.repeats.size(), 1u);
  EXPECT_EQ(plan.repeats[0].path, "coarse");
  EXPECT_EQ(plan.repeats[0].passes, 3);
  EXPECT_EQ(plan.repeats[0].at_least, 2);
  EXPECT_EQ(plan.repeats[0].at_most, 6);
  EXPECT_TRUE(plan.repeats[0].all);
}

TEST(Reader, GivesValuesInSiWithTheirOrigins) {
  const Plan plan = plan_of(cascade, {"input=data", "voxel=20cm"});
  EXPECT_DOUBLE_EQ(std::get<double>(parameter(plan, "segments", "leaf").value), 0.2);
  EXPECT_EQ(parameter(plan, "segments", "leaf").origin.text(), "--set voxel=20cm");
  EXPECT_EQ(std::get<std::int64_t>(parameter(plan, "ranges", "frames").value), 30);
  EXPECT_THAT(parameter(plan, "ranges", "frames").origin.text(), testing::EndsWith("a.yaml:9:79"));
  EXPECT_EQ(parameter(plan, "ranged", "max").origin.file, "");  // a declared default
  EXPECT_EQ(std::get<double>(parameter(plan, "ranged", "max").value), 300);
  EXPECT_TRUE(std::holds_alternative<std::monostate>(parameter(plan, "edges", "threshold").value));
  EXPECT_EQ(std::get<std::string>(parameter(plan, "coarse.solved", "loss").value), "huber");
}

TEST(Reader, TakesPathsRelativeToTheirFileAndOnTheCommandLineToTheWorkingFolder) {
  const Plan given = plan_of(cascade, {"input=data/city"});
  EXPECT_EQ(std::get<std::string>(parameter(given, "sequence", "path").value),
            (std::filesystem::current_path() / "data/city").string());
  const Folder folder;
  const auto file = folder.write("pipelines/a.yaml", R"(plumb: 1
steps:
  sequence: {use: source.sequence, with: {path: ../data}}
  written: {use: write.trajectory, from: sequence.trajectory}
)");
  const Plan plan = read_pipeline(file, {}, registry());
  EXPECT_EQ(std::get<std::string>(parameter(plan, "sequence", "path").value),
            (folder.path() / "data").string());
  EXPECT_EQ(plan.name, "a");
}

std::string path_of_sequence(const Plan& plan) {
  return std::get<std::string>(parameter(plan, "sequence", "path").value);
}

TEST(Reader, TakesADollarThatIsWrittenTwiceOrInQuotesForItself) {
  const Plan given = plan_of(cascade, {"input=/data/$$5/a$$$$b"});
  EXPECT_EQ(path_of_sequence(given), "/data/$5/a$$b");
  EXPECT_EQ(path_of_sequence(plan_of(given.resolved, {})), "/data/$5/a$$b");
  for (const char* written : {"/data/$$5", "'/data/$5'", "\"/data/$5\""}) {
    std::string text = cascade;
    text.replace(text.find("$input"), 6, written);
    const std::string declared = "  input: {type: path, about: the sequence}\n";
    text.erase(text.find(declared), declared.size());
    const Plan plan = plan_of(text, {});
    EXPECT_EQ(path_of_sequence(plan), "/data/$5") << written;
    EXPECT_EQ(path_of_sequence(plan_of(plan.resolved, {})), "/data/$5") << plan.resolved;
  }
}

TEST(Reader, ResolvesPathsBelowAFolderWithADollarInItsName) {
  const Folder folder;
  const auto file = folder.write("a$b/a.yaml", R"(plumb: 1
parameters: {input: {type: path, default: data}}
steps:
  sequence: {use: source.sequence, with: {path: $input}}
  written: {use: write.trajectory, from: sequence.trajectory}
)");
  const Plan plan = read_pipeline(file, {}, registry());
  EXPECT_EQ(path_of_sequence(plan), (folder.path() / "a$b/data").string());
  EXPECT_EQ(path_of_sequence(plan_of(plan.resolved, {})), path_of_sequence(plan));
}

TEST(Reader, BindsTheOnePortThatFits) {
  const Plan plan = plan_of(cascade);
  EXPECT_EQ(input(plan, "written", "trajectory")[0].step, index_of(plan, "sequence"));
  EXPECT_EQ(input(plan, "written", "trajectory")[0].output, 1);
  EXPECT_EQ(input(plan, "merged", "ranges")[0].output,
            0);  // of ranges and poses, the one that fits
  EXPECT_EQ(input(plan, "drift.solved", "poses")[0].output, 1);
  EXPECT_TRUE(input(plan, "coarse.near", "edges").empty());  // optional
}

TEST(Reader, CarriesTheOutputWhoseTypeItsUsersWant) {
  const Plan plan = plan_of(cascade);
  const Wire& wire = input(plan, "coarse.near", "poses")[0];
  EXPECT_EQ(wire.step, -1);
  EXPECT_EQ(wire.repeat, 0);
  const PlannedCarry& carry = plan.repeats[0].carries[wire.carry];
  EXPECT_EQ(carry.name, "poses");
  EXPECT_EQ(carry.start.step, index_of(plan, "drift.solved"));
  EXPECT_EQ(carry.start.output, 0);
  EXPECT_EQ(carry.next.step, index_of(plan, "coarse.solved"));
  EXPECT_EQ(carry.next.output, 0);
}

TEST(Reader, DrivesParametersByRows) {
  const Plan plan = plan_of(cascade);
  const PlannedParameter& max = parameter(plan, "coarse.near", "max");
  ASSERT_EQ(max.repeat, 0);
  const PlannedRepeat& repeat = plan.repeats[0];
  EXPECT_EQ(std::get<double>(max.value), 4);
  EXPECT_EQ(std::get<double>(repeat.value(max.row, 1)), 2);
  EXPECT_EQ(std::get<double>(repeat.value(max.row, 5)), 1);
  EXPECT_EQ(repeat.rows[max.row].quantity, Quantity::length);
}

TEST(Reader, ReadsWhenARepeatEnds) {
  const Plan plan = plan_of(cascade);
  ASSERT_EQ(plan.repeats[0].conditions.size(), 1u);
  const PlannedCondition& condition = plan.repeats[0].conditions[0];
  EXPECT_EQ(condition.step, index_of(plan, "coarse.rmse"));
  EXPECT_EQ(condition.metric, "");
  EXPECT_DOUBLE_EQ(*condition.falls_by_less_than, 0.02);
  EXPECT_EQ(condition.text, "rmse falls by less than 2 %");
}

TEST(Reader, SaysWhichItemsAStepHas) {
  const Plan plan = plan_of(cascade);
  EXPECT_EQ(step(plan, "ranged").domain, index_of(plan, "sequence"));
  EXPECT_EQ(step(plan, "merged").domain, index_of(plan, "ranges"));
  EXPECT_EQ(step(plan, "fpfh").domain, index_of(plan, "ranges"));
  EXPECT_EQ(step(plan, "drift.matches").domain, index_of(plan, "drift.neighbours"));
  EXPECT_EQ(step(plan, "coarse.kept").domain, index_of(plan, "edges"));
  EXPECT_EQ(step(plan, "coarse.solved").domain, -1);
}

const char* const groups_and_pieces = R"(plumb: 1
steps:
  sequence: {use: source.sequence, with: {path: x}}
  ranges:   {use: segment.by_count, from: sequence.trajectory}
  pieces:   {use: segment.merge, from: {frames: sequence, ranges: ranges}}
  edges:    {use: edges.overlap, from: {segments: pieces, poses: ranges}}
  groups:   {use: stitch.sliding_window, from: {segments: pieces, poses: ranges}}
  laid:     {use: register.icp, from: {edges: edges, targets: groups, sources: pieces}}
  chained:  {use: apply.chain, from: laid}
)";

TEST(Reader, GivesManyValuesTheItemsOfTheInputThatTheyBelongTo) {
  const Plan plan = plan_of(groups_and_pieces, {});
  EXPECT_EQ(step(plan, "laid").domain, index_of(plan, "edges"));
  // Groups of groups, and what is made of them one by one, are still of the ranges.
  std::string text = groups_and_pieces;
  text +=
      "  again: {use: stitch.sliding_window, from: {segments: groups, poses: ranges}}\n"
      "  thin: {use: filter.voxel_grid, from: again}\n"
      "  error: {use: measure.match_rmse, from: {edges: edges, segments: thin, poses: ranges}}\n";
  const Plan longer = plan_of(text, {});
  EXPECT_EQ(step(longer, "thin").domain, index_of(longer, "ranges"));
}

TEST(Reader, OrdersStepsByNeedWhateverOrderTheyAreWrittenIn) {
  const Plan plan = plan_of(cascade);
  EXPECT_THAT(
      names(plan, plan.order),
      ElementsAre("sequence", "ranges", "ranged", "merged", "segments", "fpfh", "drift.neighbours",
                  "drift.matches", "drift.solved", "edges", "coarse", "written"));
  EXPECT_THAT(
      names(plan, plan.repeats[0].body),
      ElementsAre("coarse.found", "coarse.near", "coarse.kept", "coarse.solved", "coarse.rmse"));
  const Plan turned = plan_of(R"(plumb: 1
steps:
  written: {use: write.trajectory, from: sequence}
  sequence: {use: source.sequence, with: {path: x}}
)",
                              {});
  EXPECT_THAT(names(turned, turned.order), ElementsAre("sequence", "written"));
}

TEST(Reader, NestsRepeatsAndTakesTheirLastPassFromOutside) {
  const Plan plan = plan_of(R"(plumb: 1
steps:
  sequence: {use: source.sequence, with: {path: x}}
  ranges:   {use: segment.by_count, from: sequence}
  outer:
    repeat: {passes: {share: [10 %, 5 %]}, carry: {poses: inner.solved}}
    start: {poses: ranges}
    steps:
      inner:
        repeat: {at_most: 2, carry: {moved: solved.poses}}
        start: {moved: poses}
        steps:
          solved: {use: solve.pose_graph, from: moved, with: {share: $share}}
  last: {use: solve.pose_graph, from: outer.inner.solved}
)",
                            {});
  ASSERT_EQ(plan.repeats.size(), 2u);
  EXPECT_EQ(plan.repeats[1].passes, 1);
  EXPECT_EQ(plan.repeats[1].at_most, 2);
  EXPECT_EQ(plan.repeats[1].carries[0].start.repeat, 0);
  EXPECT_EQ(plan.repeats[0].carries[0].next.step, index_of(plan, "outer.inner.solved"));
  EXPECT_EQ(parameter(plan, "outer.inner.solved", "share").repeat, 0);
  EXPECT_THAT(names(plan, plan.order), ElementsAre("sequence", "ranges", "outer", "last"));
  EXPECT_THAT(names(plan, plan.repeats[0].body), ElementsAre("outer.inner"));
}

TEST(Reader, TakesSeveralAsOneAListOrAMap) {
  const auto labels = [](const std::string& from) {
    const Plan plan =
        plan_of(cascade + "  both: {use: edges.union, from: " + from +
                "}\n  again: {use: match.fpfh_mutual, from: {edges: both, features: fpfh}}\n" +
                "  sum: {use: solve.pose_graph, from: {poses: ranges, matches: again}}\n");
    std::vector<std::string> all;
    for (const Wire& wire : input(plan, "both", "edges")) all.push_back(wire.label);
    return all;
  };
  EXPECT_THAT(labels("edges"), ElementsAre("edges"));
  EXPECT_THAT(labels("[edges, drift.neighbours]"), ElementsAre("edges", "drift.neighbours"));
  EXPECT_THAT(labels("{edges: {now: edges, before: drift.neighbours}}"),
              ElementsAre("now", "before"));
}

TEST(Reader, ExpandsAliases) {
  const Plan plan = plan_of(R"(plumb: 1
steps:
  sequence: {use: source.sequence, with: &where {path: x}}
  other: {use: source.sequence, with: *where}
  written: {use: write.trajectory, from: sequence}
  too: {use: write.trajectory, from: other}
)",
                            {});
  EXPECT_EQ(parameter(plan, "sequence", "path").value, parameter(plan, "other", "path").value);
  EXPECT_THAT(parameter(plan, "other", "path").origin.text(), HasSubstr(":4:"));
}

TEST(Reader, ResolvesToAPipelineThatReadsTheSame) {
  const Plan plan =
      plan_of(cascade, {"input=data", "voxel=20cm", "coarse.gate=2m,1m", "coarse.kept.clusters=4"});
  EXPECT_THAT(plan.resolved, HasSubstr("default: 20cm"));
  EXPECT_THAT(plan.resolved, HasSubstr("# --set voxel=20cm"));
  EXPECT_THAT(plan.resolved, HasSubstr("gate: [2m, 1m]"));
  EXPECT_THAT(plan.resolved, HasSubstr("keep_normals: true"));
  const Plan again = plan_of(plan.resolved, {});
  ASSERT_EQ(again.steps.size(), plan.steps.size());
  for (std::size_t k = 0; k < plan.steps.size(); ++k)
    for (std::size_t p = 0; p < plan.steps[k].parameters.size(); ++p)
      EXPECT_EQ(again.steps[k].parameters[p].value, plan.steps[k].parameters[p].value)
          << plan.steps[k].path;
}

TEST(Reader, LeavesParametersOpenWhereThatIsAskedFor) {
  const Folder folder;
  Overlay overlay;
  overlay.open = true;
  const Plan plan = read_pipeline(folder.write("a.yaml", cascade), overlay, registry());
  EXPECT_TRUE(std::holds_alternative<std::monostate>(parameter(plan, "sequence", "path").value));
}

}  // namespace
}  // namespace plumb
