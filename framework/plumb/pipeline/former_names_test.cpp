/// Pipelines with names of an earlier release: what they are read as, and what is said of it.
#include <gmock/gmock.h>

#include "plumb/pipeline/testing/former_testing.hpp"
#include "plumb/plugin/toy_testing.hpp"

namespace plumb {
namespace {

using test::cascade_of_now;
using test::old_cascade;
using test::without_places;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

class FormerNamesTest : public testing::Test {
 protected:
  Plan read(const std::string& text, const std::vector<std::string>& sets = {},
            const std::vector<std::string>& presets = {},
            const Registry& registry = test::registry()) const {
    const auto file = folder_.write("cascade.yaml", text);
    Overlay overlay;
    overlay.sets = sets;
    overlay.sets.push_back("input=data");
    for (const std::string& preset : presets) overlay.presets.push_back(folder_.path() / preset);
    return read_pipeline(file, overlay, registry, test::former());
  }
  std::string told(const std::string& text, const std::vector<std::string>& sets = {},
                   const std::vector<std::string>& presets = {}) const {
    try {
      read(text, sets, presets);
    } catch (const PipelineError& error) {
      return error.what();
    }
    return "";
  }
  /// "FILE:LINE:COLUMN WAS -> NOW" of all places, without the folder.
  std::vector<std::string> noted(const Plan& plan) const {
    std::vector<std::string> all;
    for (const Renaming& renaming : plan.renamings) {
      std::string place = renaming.origin.text();
      const std::string folder = folder_.path().string() + "/";
      if (place.starts_with(folder)) place.erase(0, folder.size());
      all.push_back(place + " " + renaming.was + " -> " + renaming.now);
    }
    return all;
  }
  static std::string value(const Plan& plan, const std::string& path, const std::string& name) {
    for (const PlannedStep& step : plan.steps)
      if (step.path == path) {
        const ParameterDescription* parameter = step.description->parameter(name);
        return written(*parameter,
                       step.parameters[parameter - step.description->parameters.data()].value);
      }
    return "no such step";
  }

  test::Folder folder_;
};

TEST_F(FormerNamesTest, OfEachKindAreReadAsThoseOfNow) {
  const Plan old = read(old_cascade()), now = read(cascade_of_now());
  EXPECT_EQ(without_places(old), without_places(now));
  EXPECT_THAT(now.renamings, IsEmpty());
  EXPECT_THAT(
      noted(old),
      ElementsAre(
          "cascade.yaml:9:71 length -> frames", "cascade.yaml:11:65 ranges.cuts -> ranges.ranges",
          "cascade.yaml:12:59 grid -> leaf", "cascade.yaml:13:3 angle -> 0.26 rad",
          "cascade.yaml:13:19 describe.points -> describe.fpfh",
          "cascade.yaml:16:25 edges.near -> edges.overlap", "cascade.yaml:16:44 clouds -> segments",
          "cascade.yaml:16:69 ranges.start -> ranges.poses",
          "cascade.yaml:25:30 rmse.numbers -> rmse.metrics",
          "cascade.yaml:29:20 drift.solved.trajectory -> drift.solved.poses",
          "cascade.yaml:32:82 reach -> max", "cascade.yaml:33:7 clusters -> 5",
          "cascade.yaml:34:89 robust -> huber", "cascade.yaml:35:48 graph -> edges"));
}

TEST_F(FormerNamesTest, AreWarnedOfWithTheNewOneThePlaceAndTheCure) {
  const std::string file = (folder_.path() / "cascade.yaml").string();
  const Plan plan = read(old_cascade(), {"coarse.near.reach=2m", "coarse.solved.loss=squares"});
  std::vector<std::string> warnings;
  for (const Renaming& renaming : plan.renamings) warnings.push_back(renaming.warning());
  EXPECT_EQ(warnings.front(), file +
                                  ":9:71: warning: 'length' is called 'frames' now; the old "
                                  "name goes with 0.3.0. 'plumb migrate " +
                                  file + "' rewrites the file.");
  EXPECT_THAT(warnings, testing::Contains(
                            "--set coarse.near.reach=2m: warning: 'coarse.near.reach' is called "
                            "'coarse.near.max' now; the old name goes with 0.3.0. Write --set "
                            "coarse.near.max=2m."));
  EXPECT_THAT(warnings, testing::Contains(HasSubstr("Write --set coarse.solved.loss=none.")));
  EXPECT_THAT(warnings, testing::Contains(HasSubstr(":13:3: warning: 'angle' is not given")));
}

TEST_F(FormerNamesTest, InPathsAreReadByTheStepThatTheyLeadTo) {
  const Plan plan = read(cascade_of_now(),
                         {"coarse.near.reach=2m", "segments.grid=1m", "coarse.solved.loss=robust"});
  EXPECT_EQ(value(plan, "coarse.near", "max"), "2 m");
  EXPECT_EQ(value(plan, "segments", "leaf"), "1 m");
  EXPECT_EQ(value(plan, "coarse.solved", "loss"), "huber");
  EXPECT_EQ(plan.renamings.size(), 3u);
  EXPECT_THAT(told(cascade_of_now(), {"segments.grid=1m", "segments.leaf=2m"}),
              HasSubstr("'segments.leaf' is set twice on the command line."));
}

TEST_F(FormerNamesTest, OfOurOwnPipelinesAreReadByTheNameOfWhatIsLaidOver) {
  folder_.write("p.yaml", R"(plumb: 1
name: mine
extends: cascade.yaml
set: {grid: 1 m, coarse.reach: [3 m, 2 m]}
replace:
  segments: {use: filter.voxel_grid, from: merged, with: {grid: $grid}}
  coarse.near: {use: prune.distance, from: {matches: found, poses: poses}, with: {max: $reach}}
)");
  for (const auto& text : {cascade_of_now(), old_cascade()}) {
    const Plan plan = read(text, {"coarse.reach=2m,1m"}, {"p.yaml"});
    EXPECT_EQ(value(plan, "segments", "leaf"), "1 m");
    EXPECT_EQ(value(plan, "coarse.near", "max"), "2 m");
    EXPECT_EQ(plan.repeats[0].rows[0].name, "gate");
    EXPECT_THAT(plan.resolved, Not(HasSubstr("$grid")));
    EXPECT_THAT(noted(plan),
                testing::IsSupersetOf({"p.yaml:4:7 grid -> voxel",
                                       "p.yaml:4:18 coarse.reach -> coarse.gate",
                                       "p.yaml:6:59 grid -> leaf", "p.yaml:6:65 $grid -> $voxel",
                                       "p.yaml:7:88 $reach -> $gate"}));
  }
  const std::string own =
      test::exchanged(cascade_of_now(), {{"voxel: {type", "grid: {type"}, {"$voxel", "$grid"}});
  EXPECT_EQ(value(read(own, {"grid=2m"}), "segments", "leaf"), "2 m");
  EXPECT_THAT(read(own, {"grid=2m"}).renamings, IsEmpty()) << "it declares the name itself";
  EXPECT_THAT(
      told(test::exchanged(cascade_of_now(), {{"name: cascade", "name: other"}}), {"grid=2m"}),
      HasSubstr("the pipeline has no parameter 'grid'."));
}

TEST_F(FormerNamesTest, InOverlaysAreReadWhereTheyAreLaid) {
  folder_.write("base.yaml", cascade_of_now());
  folder_.write("p.yaml", R"(plumb: 1
extends: base.yaml
remove: [coarse.near.reach]
set: {ranges.length: 7, coarse.solved.loss: squares, coarse.near.max: 1 m, coarse.at_most: 3}
replace:
  drift.neighbours: {use: edges.near, from: {clouds: segments, poses: ranges.start}}
add:
  more: {use: describe.points, from: segments}
  written_too: {use: write.trajectory, from: sequence, with: {name: b.tum}}
also:
  cascade.yaml:
    set: {segments.grid: 2 m}
    replace: {fpfh: {use: describe.points, from: segments}}
)");
  Overlay overlay;
  overlay.sets = {"input=data"};
  try {
    read_pipeline(folder_.path() / "p.yaml", overlay, test::registry(), test::former());
    FAIL();
  } catch (const PipelineError& error) {
    EXPECT_THAT(error.what(), HasSubstr("step 'more' (describe.fpfh): nothing uses what it makes"));
    EXPECT_EQ(error.diagnostics().size(), 1u) << error.what();
  }
  const Plan other = read(cascade_of_now(), {}, {"p.yaml"});
  EXPECT_EQ(value(other, "segments", "leaf"), "2 m");
  EXPECT_THAT(other.resolved, HasSubstr("angle: 0.26 rad"));
  EXPECT_THAT(noted(other), testing::IsSupersetOf({"p.yaml:12:11 segments.grid -> segments.leaf",
                                                   "p.yaml:13:27 describe.points -> describe.fpfh",
                                                   "p.yaml:13:15 angle -> 0.26 rad"}));
}

TEST_F(FormerNamesTest, BesideThoseOfNowAreOneMistake) {
  const std::string both = told(
      test::exchanged(cascade_of_now(), {{"with: {frames: 30}", "with: {frames: 30, length: 20}"},
                                         {"from: {edges: edges, segments",
                                          "from: {graph: edges, edges: edges, "
                                          "segments"}}));
  EXPECT_THAT(both, HasSubstr(":9:83: 'length' is called 'frames' now, and both are given."));
  EXPECT_THAT(both, HasSubstr("'graph' is called 'edges' now, and both are given."));
  EXPECT_THAT(both, HasSubstr("leave 'length' out."));
  EXPECT_THAT(both, Not(HasSubstr("unknown")));
  folder_.write("p.yaml",
                "plumb: 1\nextends: cascade.yaml\nset: {segments.grid: 1 m, segments.leaf: 2 m}\n");
  EXPECT_THAT(told(cascade_of_now(), {}, {"p.yaml"}),
              HasSubstr("p.yaml:3:7: 'segments.grid' is called 'segments.leaf' now, and both"));
}

/// A module from elsewhere, which calls its things as others did before.
struct Elsewhere : WholeStep {
  struct In {
    One<toy::Trajectory> trajectory;
  };
  struct Out {
    std::vector<toy::FrameRange> cuts;
    toy::Poses start;
  };
  struct Params {
    int length = 60;
  };
  static void describe(Declaration<Elsewhere>& is) {
    is.name("segment.by_count");
    is.input("trajectory", &In::trajectory, "");
    is.output("cuts", &Out::cuts, "").output("start", &Out::start, "");
    is.param("length", &Params::length).range(1, 10000).doc("frames a segment");
  }
  Out run(const In&, const Params&, Context&) const { return {}; }
};

TEST_F(FormerNamesTest, AreLeftToAStepThatStillDeclaresThem) {
  static const StepOf<Elsewhere> elsewhere;
  Registry registry;
  registry.add(elsewhere);
  test::add_graph_steps(registry);
  for (const StepDescription* step : test::registry().all())
    if (!registry.find(step->name)) registry.add(test::registry().step(step->name));
  const std::string text =
      test::exchanged(cascade_of_now(), {{"with: {frames: 30}", "with: {length: 30}"},
                                         {"ranges: ranges.ranges", "ranges: ranges.cuts"},
                                         {"poses: ranges.poses", "poses: ranges.start"}});
  const Plan plan = read(text, {"ranges.length=20"}, {}, registry);
  EXPECT_THAT(plan.renamings, IsEmpty());
  EXPECT_EQ(value(plan, "ranges", "length"), "20");
}

TEST_F(FormerNamesTest, OfChoicesAreAlsoReadInRowsAndParameters) {
  const auto text = [](const std::string& of, const std::string& row, const std::string& value) {
    return test::exchanged(
        cascade_of_now(),
        {{"parameters:",
          "parameters:\n  loss: {type: choice, of: [" + of + "], default: " + value + "}"},
         {"gate: [4 m, 2 m, 1 m]", "gate: [4 m, 2 m, 1 m]\n        kernel: [" + row + "]"},
         {"from: {poses: ranges, matches: matches}",
          "from: {poses: ranges, matches: matches}, with: {loss: $loss}"},
         {"with: {loss: huber}", "with: {loss: $kernel}"}});
  };
  const Plan plan = read(text("robust, cauchy", "cauchy, robust, squares", "robust"));
  EXPECT_EQ(value(plan, "drift.solved", "loss"), "huber");
  EXPECT_EQ(std::get<std::string>(plan.repeats[0].rows[1].values[2]), "none");
  EXPECT_EQ(without_places(plan),
            without_places(read(text("huber, cauchy", "cauchy, huber, none", "huber"))));
  EXPECT_EQ(plan.renamings.size(), 4u);
}

TEST_F(FormerNamesTest, OfARecordAreReadTheSame) {
  const auto resolved = [&](const std::string& text) {
    Overlay overlay;
    overlay.sets = {"input=" + folder_.path().string()};
    return read_pipeline(folder_.write("cascade.yaml", text), overlay, test::registry(),
                         test::former())
        .resolved;
  };
  const std::string now = resolved(cascade_of_now());
  const std::string then = test::exchanged(
      now, {{"use: describe.fpfh", "use: describe.points"}, {"frames: 30", "length: 30"}});
  const Plan plan = read_resolved(then, "run.lock.yaml", test::registry(), test::former());
  EXPECT_EQ(without_places(plan),
            without_places(read_resolved(now, "run.lock.yaml", test::registry(), test::former())));
  EXPECT_EQ(plan.renamings.size(), 2u);
}

TEST_F(FormerNamesTest, AreATableThatIsCheckedItself) {
  EXPECT_TRUE(read_former_names("", "t").steps.empty());
  EXPECT_TRUE(read_former_names("# nothing\n\n", "t").steps.empty());
  EXPECT_TRUE(read_former_names("steps:\nchoices:  # later\n", "t").steps.empty());
  EXPECT_EQ(read_former_names("choices: {a.b: {c: {d: e}}}", "t").choices.at("a.b").at("c").at("d"),
            "e");
  for (const auto& [text, said] :
       {std::pair("step: {a: b}", "t:1:1: a table of former names has no key 'step'."),
        std::pair("steps: [a]", "t:1:8: expected a map, found a list."),
        std::pair("inputs: {a: b}", "t:1:13: expected a map, found 'b'."),
        std::pair("steps: {a: [b]}", "t:1:12: expected a name, found a list.")})
    try {
      read_former_names(text, "t");
      FAIL() << text;
    } catch (const PipelineError& error) {
      EXPECT_THAT(error.what(), HasSubstr(said));
    }
}

}  // namespace
}  // namespace plumb
