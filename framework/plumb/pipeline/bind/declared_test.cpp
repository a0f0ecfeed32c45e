/// From the tree to names: what is faulty has its node, and what is sound beside it is known.
#include "plumb/pipeline/bind/declared.hpp"

#include <gmock/gmock.h>

#include <algorithm>

#include "plumb/pipeline/testing/stages_testing.hpp"

namespace plumb::pipeline {
namespace {

using test::cascade_with;
using test::index_in;
using test::Stages;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

TEST(Declared, KnowsAllThatHasANameAndFollowsNoReference) {
  Stages stages(cascade_with({{"$gate", "$gaet"}}));
  const Declared declared = stages.declared();
  EXPECT_THAT(stages.told(), IsEmpty());
  EXPECT_EQ(declared.name, "cascade");
  EXPECT_EQ(declared.steps.size(), 16u);
  EXPECT_EQ(declared.scopes.size(), 3u) << "the pipeline, drift, coarse";
  EXPECT_DOUBLE_EQ(std::get<double>(*declared.settings.at("voxel").value->value), 0.3);
  ASSERT_EQ(declared.repeats.size(), 1u);
  const Passes& passes = declared.repeats[0].passes;
  EXPECT_EQ(passes.rows.at(0).values.size(), 3u);
  EXPECT_EQ(passes.carries.at(0).name, "poses");
  EXPECT_EQ(passes.counts->columns, 3);
  EXPECT_EQ(passes.counts->at_most, 6);
  EXPECT_TRUE(declared.uses.settings.empty());
}

TEST(Declared, HasANodeForWhatIsFaultyBesideWhatIsSound) {
  Stages stages(cascade_with({{"use: describe.fpfh", "use: describe.fphf"},
                              {"default: 0.3 m", "default: 0.3"},
                              {"at_most: 6", "at_most: many"},
                              {"  written:", "  odd: {x: y}\n  written:"}}));
  const Declared declared = stages.declared();
  EXPECT_THAT(stages.told(), ElementsAre(HasSubstr(":6:34: parameter 'voxel': '0.3' has no unit"),
                                         HasSubstr(":13:19: step 'fpfh': no module offers"),
                                         HasSubstr(":27:16: repeat 'coarse': 'at_most': 'many'"),
                                         HasSubstr(":36:3: 'odd' is neither a step")));
  EXPECT_FALSE(declared.settings.at("voxel").value);
  EXPECT_TRUE(declared.settings.at("input").value);
  const DeclaredStep& fpfh = declared.steps[index_in(declared, "fpfh")];
  EXPECT_FALSE(fpfh.use);
  EXPECT_EQ(fpfh.title(), "step 'fpfh'");
  EXPECT_FALSE(declared.repeats[0].passes.counts);
  EXPECT_TRUE(declared.scopes[0].has_faulty("odd"));
  EXPECT_EQ(declared.scopes[0].find("odd"), nullptr);
  const auto sound = [](const DeclaredStep& step) { return bool(step.use); };
  EXPECT_EQ(std::count_if(declared.steps.begin(), declared.steps.end(), sound), 15);
}

TEST(Declared, HoldsTheTreeThatItPointsInto) {
  const Declared declared = Stages(cascade_with({})).declared();
  EXPECT_EQ(declared.loaded.use_count(), 1);
  EXPECT_EQ(declared.steps[0].node, declared.loaded->tree.at("steps")->at("sequence"));
  EXPECT_EQ(declared.steps[0].node->at("use")->text, "source.sequence");
}

}  // namespace
}  // namespace plumb::pipeline
