/// From names to values and wires: one faulty step causes no sentence of what depends on it and
/// hides none of anything else, and the stage before stays as it is.
#include "plumb/pipeline/bind/bound.hpp"

#include <gmock/gmock.h>

#include "plumb/pipeline/bind/former.hpp"
#include "plumb/pipeline/testing/stages_testing.hpp"

namespace plumb::pipeline {
namespace {

using test::cascade_with;
using test::index_in;
using test::Stages;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const OrFaulty<BoundStep>& step(const Bound& bound, const std::string& path) {
  return bound.steps[index_in(bound.declared, path)];
}

TEST(Bound, HasAFaultyNodeForAStepThatIsUnknownAndForEachWireFromIt) {
  Stages stages(cascade_with({{"use: describe.fpfh", "use: describe.fphf"}}));
  const Bound bound = stages.checked();
  EXPECT_THAT(stages.told(),
              ElementsAre("a.yaml:13:19: step 'fpfh': no module offers 'describe.fphf'."));
  EXPECT_FALSE(step(bound, "fpfh"));
  for (const char* path : {"drift.matches", "coarse.found"}) {
    const auto& inputs = step(bound, path)->inputs;  // edges, features
    EXPECT_TRUE(inputs[0].at(0)) << path;
    EXPECT_FALSE(inputs[1].at(0)) << path;
  }
  EXPECT_TRUE(step(bound, "segments")->parameters.at(0));
  EXPECT_TRUE(bound.uses.steps.contains(static_cast<int>(index_in(bound.declared, "segments"))));
}

TEST(Bound, IsFaultyOnlyWhereItIsSoThatAllElseIsToldToo) {
  Stages stages(cascade_with({{"use: describe.fpfh", "use: describe.fphf"},
                              {"frames: 30", "frames: 1e2"},
                              {"from: sequence.frames", "from: sequence.fames"},
                              {"metric: rmse", "metric: kept"},
                              {"  written:",
                               "  spare: {use: filter.voxel_grid, from: merged}\n"
                               "  written:"}}));
  const Bound bound = stages.checked();
  EXPECT_THAT(
      stages.told(),
      ElementsAre(HasSubstr(":9:79: step 'ranges'"), HasSubstr(":10:42: step 'sequence'"),
                  HasSubstr(":13:19: step 'fpfh'"), HasSubstr(":25:30: repeat 'coarse': 'until'"),
                  HasSubstr(":36:3: step 'spare'")));
  EXPECT_FALSE(step(bound, "ranges")->parameters.at(0));
  EXPECT_FALSE(step(bound, "ranged")->inputs.at(0).at(0));
  EXPECT_FALSE(bound.repeats[0].conditions.at(0));
  EXPECT_TRUE(bound.repeats[0].carries.at(0));
}

TEST(Bound, LacksAnInputThatAMisspeltKeyMayHaveMeant) {
  Stages stages(cascade_with({{"from: merged", "form: merged"}}));
  const Bound bound = stages.checked();
  EXPECT_THAT(stages.told(), ElementsAre(HasSubstr("unknown key 'form'.")));
  EXPECT_FALSE(step(bound, "segments")->inputs.at(0).at(0));
}

TEST(Bound, TakesWhatARowHoldsFromAStepThatIsKnown) {
  Stages stages(cascade_with(
      {{"      found:", "      odd: {use: foo.bar, with: {x: $gate}}\n      found:"}}));
  const Bound bound = stages.checked();
  EXPECT_THAT(stages.told(), ElementsAre(HasSubstr("no module offers 'foo.bar'.")));
  EXPECT_EQ(bound.repeats[0].rows[0].quantity, Quantity::length);
  EXPECT_EQ(bound.repeats[0].rows[0].values.size(), 3u);
}

TEST(Bound, TellsOnceOfWhatIsCarriedOnAsItself) {
  Stages alone(cascade_with({{"carry: {poses: solved}", "carry: {poses: poses}"}}));
  EXPECT_FALSE(alone.checked().repeats[0].carries.at(0));
  EXPECT_THAT(alone.told(),
              ElementsAre("a.yaml:24:22: repeat 'coarse': 'poses' is carried on from a step of the "
                          "body, and 'poses' is none."));
  Stages in_turn(cascade_with(
      {{"carry: {poses: solved}", "carry: {poses: more, more: poses}"},
       {"start: {poses: drift.solved}", "start: {poses: drift.solved, more: drift.solved}"}}));
  in_turn.checked();
  EXPECT_THAT(in_turn.told(), ElementsAre(HasSubstr("'more' is carried on from a step of the body, "
                                                    "and 'poses' is none.")));
}

TEST(Bound, LeavesNamesAndTreeAsTheyWere) {
  Stages stages(
      test::exchanged(test::old_cascade(), {{"{type: path,", "{type: path, default: data,"}}));
  const Declared declared = stages.declared();
  const Bound first = stages.bound(declared), second = stages.bound(declared);
  EXPECT_THAT(stages.told(), IsEmpty());
  EXPECT_TRUE(declared.uses.settings.empty());
  EXPECT_THAT(first.uses.settings, ElementsAre("input", "voxel"));
  EXPECT_EQ(first.uses.steps, second.uses.steps);
  EXPECT_EQ(first.now, second.now);
  ASSERT_EQ(first.steps.size(), second.steps.size());
  for (std::size_t k = 0; k < first.steps.size(); ++k)
    for (std::size_t p = 0; p < first.steps[k]->parameters.size(); ++p)
      EXPECT_EQ(first.steps[k]->parameters[p]->value, second.steps[k]->parameters[p]->value);

  const auto loss = [](const Node& tree) {
    const Node* solved = tree.at("steps")->at("coarse")->at("steps")->at("solved");
    return solved->at("with")->at("loss")->text;
  };
  EXPECT_EQ(loss(stages.tree()), "robust");
  EXPECT_EQ(loss(tree_of_now(stages.tree(), first.now)), "huber");
  EXPECT_THAT(declared.now, IsEmpty());
}

}  // namespace
}  // namespace plumb::pipeline
