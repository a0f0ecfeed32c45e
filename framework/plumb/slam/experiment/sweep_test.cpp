#include <gmock/gmock.h>

#include "plumb/data/io/file_testing.hpp"
#include "plumb/slam/experiment/experiment.hpp"

namespace plumb::experiment {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::vector<std::string> names(const std::vector<std::string>& sweeps, SweepBy by) {
  std::vector<Axis> axes;
  for (const std::string& sweep : sweeps) axes.push_back(axis_of(sweep));
  std::vector<std::string> all;
  for (const Variant& variant : swept_variants(axes, by)) all.push_back(variant.name);
  return all;
}

TEST(Sweep, TriesEachValueWithEach) {
  EXPECT_THAT(names({"voxel_size=0.2m,0.3m", "gate=2m,1m"}, SweepBy::grid),
              ElementsAre("voxel_size=0.2m,gate=2m", "voxel_size=0.2m,gate=1m",
                          "voxel_size=0.3m,gate=2m", "voxel_size=0.3m,gate=1m"));
}

TEST(Sweep, TriesTheFirstOnesTogetherThenTheSecondOnes) {
  EXPECT_THAT(names({"voxel_size=0.2m,0.3m", "gate=2m,1m"}, SweepBy::paired),
              ElementsAre("voxel_size=0.2m,gate=2m", "voxel_size=0.3m,gate=1m"));
  EXPECT_THAT(io::refusal([] {
                names({"voxel_size=0.2m,0.3m", "gate=2m"}, SweepBy::paired);
              }),
              HasSubstr("'voxel_size' has 2 values and 'gate' 1"));
}

TEST(Sweep, ChangesOneAtATime) {
  EXPECT_THAT(names({"voxel_size=0.2m,0.3m", "gate=2m"}, SweepBy::one_at_a_time),
              ElementsAre("voxel_size=0.2m", "voxel_size=0.3m", "gate=2m"));
}

TEST(Sweep, TakesARowsValueInBrackets) {
  const Axis axis = axis_of("coarse.gate=[3 m,1 m],[2m],1m");
  EXPECT_EQ(axis.name, "coarse.gate");
  ASSERT_EQ(axis.values.size(), 3u);
  ASSERT_EQ(axis.values[0].items.size(), 2u);
  EXPECT_EQ(axis.values[0].items[1].text, "1 m");
  EXPECT_TRUE(axis.values[2].is_scalar());
  EXPECT_THAT(names({"coarse.gate=[3 m,1 m],[2m],1m"}, SweepBy::grid),
              ElementsAre("coarse.gate=[3m,1m]", "coarse.gate=[2m]", "coarse.gate=1m"));
}

TEST(Sweep, SetsWhatItIsCalled) {
  const auto variants = swept_variants({axis_of("input=a/b,c")}, SweepBy::grid);
  EXPECT_EQ(variants[0].name, "input=a_b") << "a name of a folder";
  ASSERT_EQ(variants[0].edits.size(), 1u);
  EXPECT_EQ(variants[0].edits[0].tree.at("set")->at("input")->text, "a/b");
  EXPECT_EQ(variants[0].edits[0].tree.at("set")->find("input")->origin.text(),
            "--sweep input=a/b,c");
  EXPECT_THAT(variants[0].swept, ElementsAre(std::pair<std::string, std::string>("input", "a/b")));
}

TEST(Sweep, IsRefusedWithoutValuesOrWithMoreThanAnybodyRuns) {
  EXPECT_THAT(io::refusal([] { axis_of("voxel_size"); }), HasSubstr("expected NAME=VALUE,VALUE"));
  EXPECT_THAT(io::refusal([] { axis_of("voxel_size=1m,,2m"); }), HasSubstr("a value is missing"));
  const std::string ten = "=1,2,3,4,5,6,7,8,9,10";
  EXPECT_THAT(io::refusal([&] {
                names({"a" + ten, "b" + ten, "c" + ten, "d" + ten}, SweepBy::grid);
              }),
              HasSubstr("more than 1000 variants"));
  EXPECT_EQ(names({"a" + ten, "b" + ten, "c" + ten}, SweepBy::grid).size(), 1000u);
}

}  // namespace
}  // namespace plumb::experiment
