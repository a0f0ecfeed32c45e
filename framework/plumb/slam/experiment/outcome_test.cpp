#include "plumb/slam/experiment/outcome.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "plumb/data/io/file_testing.hpp"
#include "plumb/slam/experiment/measured_testing.hpp"

namespace plumb::experiment {
namespace {

using io::TestFolder;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

/// Two inputs and two replicates; B is a fifth lower, and fails once.
Outcome outcome() {
  Outcome made;
  made.name = "stages";
  made.about = "does it matter?";
  made.measured = test::measured(
      {"a", "b"}, 2,
      [](std::size_t v, std::size_t k, std::size_t r) {
        const double value = (v == 0 ? 1 : 0.8) * static_cast<double>(k + 1);
        return v == 1 && k == 1 && r == 1 ? std::nullopt : std::optional(value);
      },
      2);
  for (std::size_t v = 0; v < 2; ++v)
    made.measured.at(v, 0).figures.push_back(
        {{"time", 4.0 + static_cast<double>(v), "CPU s"}, {}, v == 1});
  Figure& first = made.measured.at(0, 0).figures.front();
  first.segments = {true, {0.5, 1.5}, {1, 1}};
  made.measured.at(0, 0).seconds = 2.5;
  made.measured.at(0, 0).made = 7;
  made.rules.primary = "error.fine.ate";
  made.replicates.count = 2;
  made.replicates.phase = true;
  made.swept = {{}, {{"voxel_size", "0.3m"}}};
  made.numbers = judge(made.measured, made.rules);
  return made;
}

TEST(Outcome, AsATableHasARowByInputAndASentenceAVariant) {
  const std::string table = outcome_table(outcome());
  EXPECT_THAT(table, HasSubstr("error.fine.ate [m], which decides\n"
                               "                      a      b\n"
                               "  input_0             1    0.8\n"
                               "  input_1             2    1.6\n"
                               "  geometric mean  1.414  1.131\n"));
  EXPECT_THAT(table, HasSubstr("  b is 20 % lower than a: no result on 1 of 2 inputs\n"));
  EXPECT_THAT(table, HasSubstr("time [CPU s]\n"));
  EXPECT_THAT(table, AllOf(HasSubstr("  5*\n"),
                           HasSubstr("* was spent in part in earlier runs or by another variant")));
  EXPECT_THAT(table,
              HasSubstr("error.fine.ate decides: lower is better, up to 5 % is equivalent."));
  EXPECT_THAT(table,
              HasSubstr("With 2 inputs and 1 variant the smallest p that could be reached is "
                        "0.5: a statement beyond these data needs 6 inputs"));
  EXPECT_THAT(table, HasSubstr("failed: variant 'b' on input_1, replicate 2: step 'matched': needs "
                               "normals; put estimate.normals before it\n"));
  EXPECT_THAT(table, HasSubstr("2 replicates an input (seed 0)"));
}

TEST(Outcome, AsAPageHasTablesThatNothingBreaks) {
  Outcome odd = outcome();
  odd.measured.variants[1] = "b|c";
  odd.numbers = judge(odd.measured, odd.rules);
  const std::string page = outcome_markdown(odd);
  EXPECT_THAT(page, HasSubstr("# stages\n\ndoes it matter?\n"));
  EXPECT_THAT(page,
              HasSubstr("|  | a | b\\|c |\n| --- | ---: | ---: |\n| input\\_0 | 1 | 0.8 |\n"));
  EXPECT_THAT(
      page, HasSubstr("| b\\|c | 20 % lower than a | 2 / 0 / 0 |  | no result on 1 of 2 inputs |"));
}

TEST(Outcome, AsAPlotHasARowAVariant) {
  Outcome odd = outcome();
  odd.measured.variants[1] = "b<c>&\"d\"";
  odd.numbers = judge(odd.measured, odd.rules);
  const std::string plot = outcome_svg(odd);
  EXPECT_THAT(plot, testing::StartsWith("<svg xmlns='http://www.w3.org/2000/svg'"));
  EXPECT_THAT(plot, testing::EndsWith("</svg>\n"));
  EXPECT_THAT(plot, AllOf(HasSubstr(">b&lt;c>&amp;&quot;d&quot;</text>"),
                          HasSubstr(">x 0.8</text>"), HasSubstr(">x 1</text>")));
  EXPECT_THAT(plot, HasSubstr("<title>fails</title></circle>"));
  odd.numbers.clear();
  EXPECT_THAT(outcome_svg(odd), HasSubstr("nothing was compared"));
}

TEST(Outcome, AsCsvHasALineForEachNumberOfEachRun) {
  const std::string csv = outcome_csv(outcome());
  EXPECT_THAT(csv, testing::StartsWith(
                       "variant,input,replicate,metric,value,unit,cached,failed,voxel_size\n"
                       "a,input_0,1,error.fine.ate,1,m,0,0,\n"));
  EXPECT_THAT(csv, HasSubstr("b,input_0,1,time,5,CPU s,1,0,0.3m\n"));
  EXPECT_THAT(csv, HasSubstr("b,input_1,2,,,,0,1,0.3m\n"));
}

TEST(Outcome, AsJsonHasWhatWasMeasuredAndTheVerdicts) {
  const auto json = nlohmann::json::parse(outcome_json(outcome()));
  EXPECT_EQ(json["variants"], nlohmann::json({"a", "b"}));
  EXPECT_EQ(json["runs"].size(), 8u);
  EXPECT_EQ(json["runs"][0]["numbers"][0]["segments"]["sum"], nlohmann::json({0.5, 1.5}));
  EXPECT_EQ(json["swept"]["b"]["voxel_size"].get<std::string>(), "0.3m");
  const auto& number = json["numbers"][0];
  EXPECT_EQ(number["name"].get<std::string>(), "error.fine.ate");
  EXPECT_FALSE(number["exploratory"].get<bool>());
  EXPECT_NEAR(number["variants"]["b"]["values"][1].get<double>(), 1.6, 1e-12);
  const auto& against = number["variants"]["b"]["against"];
  EXPECT_EQ(against["verdict"].get<std::string>(), "fails");
  EXPECT_NEAR(against["ratio"].get<double>(), 0.8, 1e-12);
  EXPECT_FALSE(number["variants"]["a"].contains("against"));
  EXPECT_TRUE(json["numbers"][1]["variants"]["b"]["values"][0].is_null()) << "of a cache";
}

TEST(Outcome, IsReadBackAsABaseline) {
  const TestFolder folder;
  const Outcome then = outcome();
  const Outcome back = outcome_of_json(folder.write("then.json", outcome_json(then)));
  EXPECT_EQ(back.name, "stages");
  EXPECT_EQ(back.rules.primary, "error.fine.ate");
  EXPECT_EQ(back.measured.variants, then.measured.variants);
  EXPECT_EQ(back.measured.inputs, then.measured.inputs);
  EXPECT_EQ(back.measured.at(1, 1, 1).failure, then.measured.at(1, 1, 1).failure);
  EXPECT_EQ(back.measured.at(0, 0).figures[0].segments.sum, (std::vector<double>{0.5, 1.5}));
  EXPECT_TRUE(back.measured.at(0, 0).figures[0].segments.root);
  EXPECT_TRUE(back.measured.at(1, 0).figures[1].from_cache);
  EXPECT_EQ(not_comparable(back, then), "");
  for (const Judged& judged : judge_against(back.measured, then.measured, then.rules))
    for (const Contrast& contrast : judged.contrasts) EXPECT_EQ(contrast.method, Method::identical);
}

TEST(Outcome, ThatIsNoneIsRefusedWithASentence) {
  const TestFolder folder;
  const auto refused = [&](const std::string& text) {
    return io::refusal([&] { outcome_of_json(folder.write("x.json", text)); });
  };
  for (const char* text : {"", "{", "[]", "{\"experiment\": 1}", "\xff\xfe"})
    EXPECT_THAT(refused(text), HasSubstr("x.json: is not what plumb compare writes")) << text;
  std::string whole = outcome_json(outcome());
  const auto changed = [&](const std::string& old, const std::string& fresh) {
    std::string text = whole;
    text.replace(text.find(old), old.size(), fresh);
    return refused(text);
  };
  EXPECT_THAT(changed("\"input\":\"input_1\"", "\"input\":\"nowhere\""),
              HasSubstr("'nowhere' is not one of"));
  EXPECT_THAT(changed("\"sum\":[0.5,1.5]", "\"sum\":[0.5]"), HasSubstr("not equally many"));
  EXPECT_THAT(changed("\"count\":2", "\"count\":999999999999"),
              HasSubstr("more runs than anybody"));
  EXPECT_THAT(changed("\"replicate\":2", "\"replicate\":3"), HasSubstr("none of those"));
}

TEST(Outcome, IsComparableOnlyWithOneOfTheSameNumberAndReplicatesThatHasAllOfIt) {
  const Outcome then = outcome();
  Outcome now = then;
  EXPECT_EQ(not_comparable(then, now), "");
  now.rules.primary = "time";
  EXPECT_THAT(not_comparable(then, now), HasSubstr("'error.fine.ate' and this one's 'time'"));
  now = then, now.replicates.count = 3;
  EXPECT_THAT(not_comparable(then, now), HasSubstr("replicates"));
  now = then, now.replicates.seed = 9;
  EXPECT_EQ(not_comparable(then, now), "") << "other draws of the same disturbances";
  now = then, now.measured.inputs[1].bytes += 1, now.measured.variants = {"a", "c"};
  EXPECT_THAT(not_comparable(then, now), HasSubstr("not in it: variant c, input input_1 (by name"));
  EXPECT_THAT(only_in(then, now), ElementsAre("variant b", "input input_1"));
  now = then, now.measured.variants = {"a"}, now.measured.inputs.pop_back();
  EXPECT_EQ(not_comparable(then, now), "") << "it need not be all of the other";
  EXPECT_THAT(only_in(then, now), ElementsAre("variant b", "input input_1"));
}

TEST(Outcome, WithoutAnythingSharedSaysNothingDecides) {
  Outcome empty = outcome();
  empty.rules.primary = "nothing";
  empty.numbers = judge(empty.measured, empty.rules);
  EXPECT_EQ(empty.primary(), nullptr);
  EXPECT_FALSE(empty.any(Verdict::worse));
  EXPECT_THAT(outcome_table(empty), Not(HasSubstr("which decides")));
}

TEST(UsualPrimary, IsTheErrorAgainstATruthWhereThereIsOne) {
  const auto of = [](std::vector<std::string> names) {
    std::vector<Number> numbers;
    for (auto& name : names) numbers.push_back({name, 0, "m"});
    return usual_primary(numbers);
  };
  EXPECT_EQ(of({"match_rmse.fine", "error.fine.rpe_translation", "error.fine.ate", "time"}),
            "error.fine.ate");
  EXPECT_EQ(of({"match_rmse.fine", "relation_error.fine.translation"}),
            "relation_error.fine.translation");
  EXPECT_EQ(of({"time", "match_rmse.fine"}), "match_rmse.fine");
  EXPECT_EQ(of({"solved.cost", "time"}), "solved.cost");
  EXPECT_EQ(of({}), "");
}

}  // namespace
}  // namespace plumb::experiment
