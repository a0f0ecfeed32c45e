#include "plumb/slam/experiment/replicate.hpp"

#include <gmock/gmock.h>

#include <map>
#include <set>

namespace plumb::experiment {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

ParameterDescription parameter(const std::string& name, ParameterKind kind) {
  ParameterDescription made;
  made.name = name;
  made.kind = kind;
  made.low = 0, made.high = 1e9;
  return made;
}

/// A source, a step that cuts, one that draws in a repeat, and one whose seed is a word.
struct Disturbed : testing::Test {
  StepDescription source, cut, draw, other;
  Plan plan;
  Disturbed() {
    source.parameters = {parameter("skip_frames", ParameterKind::integer),
                         parameter("drop_frames", ParameterKind::number),
                         parameter("drop_seed", ParameterKind::integer)};
    cut.parameters = {parameter("phase", ParameterKind::number)};
    draw.parameters = {parameter("seed", ParameterKind::integer)};
    other.parameters = {parameter("seed", ParameterKind::text)};
    for (const auto& [path, description] :
         {std::pair<const char*, const StepDescription*>{"sequence", &source},
          {"ranges", &cut},
          {"coarse.kept", &draw},
          {"garden", &other}}) {
      PlannedStep step;
      step.path = path;
      step.description = description;
      plan.steps.push_back(step);
    }
  }
  std::vector<std::string> sets(std::size_t replicate, std::uint64_t seed = 0,
                                const std::string& input = "street") const {
    Replicates all;
    all.disturb_all();
    all.seed = seed;
    return disturbances(all, replicate, input, plan);
  }
};

TEST_F(Disturbed, TheFirstReplicateIsNot) { EXPECT_THAT(sets(0), IsEmpty()); }

TEST_F(Disturbed, EveryStepIsThatHasSomethingForIt) {
  std::vector<std::string> names;
  for (const std::string& set : sets(1)) names.push_back(set.substr(0, set.find('=')));
  EXPECT_THAT(names, ElementsAre("sequence.skip_frames", "sequence.drop_frames",
                                 "sequence.drop_seed", "ranges.phase", "coarse.kept.seed"));
  EXPECT_EQ(sets(1)[1], "sequence.drop_frames=1 %");
}

TEST_F(Disturbed, ReplicatesAreAlikeForTheSameSeedAndUnlikeEachOther) {
  std::set<std::string> seeds;
  for (std::size_t k = 1; k <= 50; ++k) {
    EXPECT_EQ(sets(k), sets(k));
    seeds.insert(sets(k).back());
    seeds.insert(sets(k, 1).back());
  }
  EXPECT_GT(seeds.size(), 97u);
}

TEST_F(Disturbed, EachInputIsInAWayOfItsOwn) {
  std::map<std::string, int> skipped;  // of the same replicate, over inputs
  for (int k = 0; k < 60; ++k) ++skipped[sets(1, 0, "street_" + std::to_string(k)).front()];
  EXPECT_THAT(skipped, testing::SizeIs(6)) << "0 to 5 frames";
  for (const auto& [set, count] : skipped) EXPECT_LT(count, 25) << set;
}

TEST_F(Disturbed, OneThingAloneIsAsItIsWithTheOthers) {
  Replicates one;
  one.phase = true;
  Replicates all;
  all.disturb_all();
  EXPECT_THAT(disturbances(one, 3, "street", plan).size(), 1u);
  all.skip_frames = 0, all.drop_frames = 0;
  EXPECT_EQ(disturbances(one, 3, "street", plan).front(),
            disturbances(all, 3, "street", plan).front());
}

TEST_F(Disturbed, WhatNoStepHasIsNamed) {
  Replicates all;
  all.disturb_all();
  EXPECT_THAT(not_disturbed(all, plan), IsEmpty());
  plan.steps.erase(plan.steps.begin());
  EXPECT_THAT(not_disturbed(all, plan), ElementsAre("skip_frames", "drop_frames", "drop_seed"));
}

}  // namespace
}  // namespace plumb::experiment
