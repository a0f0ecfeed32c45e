#include "plumb/pipeline/print/schema.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <regex>

#include "plumb/pipeline/testing/test_steps.hpp"

namespace plumb {
namespace {

nlohmann::json schema() { return nlohmann::json::parse(pipeline_schema(test::registry())); }

/// The rule for one step: what `with` and `from` may hold.
nlohmann::json rule(const std::string& step) {
  const nlohmann::json all = schema();
  for (const auto& r : all["definitions"]["step"]["allOf"])
    if (r["if"]["properties"]["use"]["const"] == step) return r["then"]["properties"];
  return {};
}
bool matches(const nlohmann::json& value, const std::string& text) {
  return std::regex_match(text, std::regex(value["pattern"].get<std::string>()));
}

TEST(Schema, ListsEveryStepOnce) {
  const auto names = schema()["definitions"]["step"]["properties"]["use"]["enum"];
  EXPECT_EQ(names.size(), test::registry().all().size());
  EXPECT_EQ(names[0], "apply.chain");
}

TEST(Schema, DescribesParametersWithUnitRangeAndDefault) {
  const auto leaf = rule("filter.voxel_grid")["with"]["properties"]["leaf"];
  EXPECT_EQ(leaf["default"], "0.3 m");
  EXPECT_EQ(leaf["markdownDescription"],
            "Edge length of a cell.\n\n*length, 0.01 m to 100 m*, default `0.3 m`");
  for (const char* good : {"0.3 m", "2m", "1e-1 km", "$voxel", ".5 mm"})
    EXPECT_TRUE(matches(leaf, good)) << good;
  for (const char* bad : {"0.3", "0.3 deg", "m", "-1 m", "none", "1 m 2", "$a.b", "nan m"})
    EXPECT_FALSE(matches(leaf, bad)) << bad;
  const auto frames = rule("segment.by_count")["with"]["properties"]["frames"];
  EXPECT_EQ(frames["minimum"], 1);
  EXPECT_EQ(frames["maximum"], 10000);
  EXPECT_TRUE(matches(rule("edges.overlap")["with"]["properties"]["threshold"], "none"));
  EXPECT_EQ(rule("source.sequence")["with"]["required"], nlohmann::json({"path"}));
}

TEST(Schema, KnowsThePortsOfEveryStep) {
  EXPECT_EQ(rule("source.sequence")["from"], false);
  const auto from = rule("measure.match_rmse")["from"];
  EXPECT_EQ(from["properties"].size(), 4u);
  EXPECT_EQ(from["additionalProperties"], false);
}

/// Every object with named properties refuses others, but for the fragments that only add to one.
void expect_closed(const nlohmann::json& node, const std::string& path) {
  const bool named = node.is_object() && node.contains("properties") && node.contains("type");
  if (named) {
    EXPECT_TRUE(node.contains("additionalProperties")) << path;
  }
  if (node.is_structured())
    for (const auto& [key, value] : node.items()) expect_closed(value, path + "/" + key);
}
TEST(Schema, LeavesNoObjectOpen) { expect_closed(schema(), ""); }

}  // namespace
}  // namespace plumb
