#include "plumb/plugin/manifest.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "plumb/data/io/file_testing.hpp"
#include "plumb/data/toy_testing.hpp"
#include "plumb/plugin/registry.hpp"

namespace plumb {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::StartsWith;

/// A step of version 7 on segments, with a whole parameter whose default is 5, in a module with
/// zlib.
Manifest small_manifest() {
  StepDescription step;
  step.name = "test.small";
  step.version = 7;
  step.items = type_of<toy::Segment>().kind;
  step.inputs = {{"frames", &type_of<toy::Frame>(), Access::each, false, "to merge", ""},
                 {"ranges", &type_of<toy::FrameRange>(), Access::item, false, "", ""},
                 {"scale", &type_of<toy::Metrics>(), Access::item, true, "", ""}};
  step.outputs = {{"segment", &type_of<toy::Segment>(), Emission::one, "", ""}};
  ParameterDescription count;
  count.name = "count";
  count.kind = ParameterKind::integer;
  count.standard = std::int64_t{5};
  count.low = 0, count.high = 100;
  step.parameters = {count};
  return {abi_tag(), {step}, {"BSD-3-Clause AND Zlib", "zlib is Zlib."}};
}

std::string with(const std::string& old, const std::string& fresh) {
  std::string text = manifest_text(small_manifest());
  return text.replace(text.find(old), old.size(), fresh);
}

/// The manifest's text after a change to its JSON.
template <class Change>
std::string changed(Change change) {
  json all = json::parse(manifest_text(small_manifest()));
  change(all);
  return all.dump();
}
json& named(json& list, const std::string& name) {
  for (json& one : list)
    if (one.at("name") == name) return one;
  throw std::logic_error("no " + name);
}

std::string refusal_of(const std::string& text) {
  return io::refusal([&] { read_manifest(text, "small.json"); });
}

TEST(Manifest, IsReadAsItWasWritten) {
  const std::string text = manifest_text(small_manifest());
  EXPECT_EQ(manifest_text(read_manifest(text, "small.json")), text);
}

TEST(Manifest, HoldsTheLicencesOfItsModule) {
  const Manifest manifest = read_manifest(manifest_text(small_manifest()), "small.json");
  EXPECT_EQ(manifest.licence.text(), "BSD-3-Clause AND Zlib");
  EXPECT_EQ(manifest.licence.reason, "zlib is Zlib.");
  EXPECT_THAT(step_json(manifest.steps[0], manifest.licence),
              HasSubstr("\"expression\": \"BSD-3-Clause AND Zlib\""));
}

TEST(Manifest, WithoutLicencesIsThatOfAnEarlierBuild) {
  Manifest earlier = small_manifest();
  earlier.licence = {};
  const std::string text = manifest_text(earlier);
  EXPECT_EQ(text.find("licence"), std::string::npos);
  EXPECT_EQ(read_manifest(text, "small.json").licence.text(), "not stated");
  EXPECT_THAT(step_json(earlier.steps[0], earlier.licence), HasSubstr("\"licence\": null"));
}

TEST(Manifest, WithALicenceThatIsNoneIsRefused) {
  const std::string expression = "\"BSD-3-Clause AND Zlib\"";
  EXPECT_THAT(refusal_of(with(expression, "\"\"")),
              HasSubstr("small.json: not a manifest that can be used: its licence is empty"));
  EXPECT_THAT(refusal_of(with(expression, "\"GPL\"")),
              HasSubstr("names 'GPL', which is not known"));
  EXPECT_THAT(refusal_of(with(expression, "7")), HasSubstr("not a manifest that can be used"));
  EXPECT_THAT(refusal_of(with("\"reason\"", "\"because\"")), HasSubstr("'reason' not found"));
}

TEST(Manifest, TakesNoOtherNumberForAWholeOne) {
  const auto told = HasSubstr("small.json: not a manifest that can be used: a whole number");
  for (const char* version : {"7.5", "1e300", "2147483648", "true"})
    EXPECT_THAT(refusal_of(with("\"version\": 7", std::string("\"version\": ") + version)), told);
  for (const char* standard : {"5.5", "-1e300", "9223372036854775808", "\"5\""})
    EXPECT_THAT(refusal_of(with("\"default\": 5", std::string("\"default\": ") + standard)), told);
  EXPECT_EQ(refusal_of(with("\"default\": 5", "\"default\": -9223372036854775808")),
            "(nothing was refused)");
}

TEST(Manifest, DefinesWhatItsPortsAreOf) {
  const json all = json::parse(manifest_text(small_manifest()));
  std::vector<std::string> kinds, types;
  for (const json& kind : all.at("kinds")) kinds.push_back(kind.at("name"));
  for (const json& type : all.at("types")) types.push_back(type.at("name"));
  EXPECT_THAT(kinds, testing::ElementsAre("frame", "segment"));
  EXPECT_THAT(types, testing::ElementsAre("Frame", "FrameRange", "Metrics", "Segment"));
}

/// As of a module that is not loaded: its type and its kind become known, without code.
TEST(Manifest, RegistersWhatNoOtherDefines) {
  const std::string text = changed([](json& all) {
    named(all["kinds"], "segment")["ranges"] = "test.PlotRange";
    named(all["kinds"], "segment")["name"] = "test.plot";
    named(all["types"], "Segment")["name"] = "test.Crop";
    named(all["types"], "test.Crop")["items"] = "test.plot";
    named(all["types"], "FrameRange")["name"] = "test.PlotRange";
    named(all["types"], "test.PlotRange")["items"] = "test.plot";
    named(all["types"], "test.PlotRange")["layout"] = "40/8";
    all["steps"][0]["items"] = "test.plot";
    all["steps"][0]["inputs"][1]["type"] = "test.PlotRange";
    all["steps"][0]["outputs"][0]["type"] = "test.Crop";
  });
  const StepDescription step = read_manifest(text, "small.json").steps.at(0);
  EXPECT_EQ(step.items, find_kind("test.plot"));
  EXPECT_EQ(step.items->parts, "frame");
  EXPECT_EQ(step.items->ranges, "test.PlotRange");
  EXPECT_EQ(step.inputs[0].type, &type_of<toy::Frame>());
  EXPECT_EQ(step.inputs[1].type, find_type("test.PlotRange"));
  EXPECT_EQ(step.inputs[1].type->layout, "40/8");
  EXPECT_EQ(step.inputs[1].type->kind, step.items);
  EXPECT_EQ(step.outputs[0].type, find_type("test.Crop"));
  EXPECT_TRUE(step.outputs[0].type->large);
  EXPECT_EQ(step.outputs[0].type->code, nullptr);
}

/// What is said of a manifest that defines Segment otherwise than it is defined here.
std::string told_of_segment(const char* member, const json& value) {
  const std::string said =
      refusal_of(changed([&](json& all) { named(all["types"], "Segment")[member] = value; }));
  EXPECT_THAT(said, StartsWith("small.json: not a manifest that can be used: "));
  EXPECT_THAT(said, testing::EndsWith("; build the module again"));
  return said;
}

TEST(Manifest, WithATypeThatIsDefinedOtherwiseIsRefused) {
  const std::string twice = "type 'Segment' is defined twice, and not alike: ";
  EXPECT_THAT(told_of_segment("version", 2),
              HasSubstr(twice + "its version is 1 there and 2 here"));
  EXPECT_THAT(told_of_segment("layout", "1/1"),
              HasSubstr("its layout in memory is " + type_of<toy::Segment>().layout +
                        " there and 1/1 here"));
  EXPECT_THAT(told_of_segment("items", nullptr),
              HasSubstr("one per segment there and one for the whole pipeline here"));
  EXPECT_THAT(told_of_segment("items", "frame"),
              HasSubstr("one per segment there and one per frame here"));
  EXPECT_THAT(told_of_segment("large", false), HasSubstr(twice + "its traits are others"));
  EXPECT_THAT(told_of_segment("has_empty", true), HasSubstr(twice + "its traits are others"));
  EXPECT_THAT(told_of_segment("version", 1.5), HasSubstr("a whole number"));
}

TEST(Manifest, WithAKindThatIsDefinedOtherwiseIsRefused) {
  const std::string text =
      changed([](json& all) { named(all["kinds"], "segment")["parts"] = "edge"; });
  EXPECT_THAT(refusal_of(text), HasSubstr("item kind 'segment' is defined twice, and not alike"));
}

TEST(Manifest, ThatNamesWhatIsNotDefinedIsRefused) {
  EXPECT_THAT(told_of_segment("items", "test.shard"),
              HasSubstr("item kind 'test.shard' is named and not defined"));
  EXPECT_THAT(refusal_of(changed([](json& all) { all["steps"][0]["items"] = "test.shard"; })),
              HasSubstr("item kind 'test.shard' is named and not defined"));
  for (const char* ports : {"inputs", "outputs"})
    EXPECT_THAT(
        refusal_of(changed([&](json& all) { all["steps"][0][ports][0]["type"] = "test.Shard"; })),
        HasSubstr("type 'test.Shard' is named and not defined"));
}

/// A manifest that also defines the kind test.lot and the type test.Lot of it, and a change that
/// makes it one to be refused.
template <class Change>
std::string with_lots(Change change) {
  return changed([&](json& all) {
    json kind = named(all["kinds"], "segment"), type = named(all["types"], "Segment");
    kind["name"] = type["items"] = "test.lot";
    type["name"] = "test.Lot";
    all["kinds"].insert(all["kinds"].begin(), kind);
    all["types"].insert(all["types"].begin(), type);
    change(all);
  });
}

TEST(Manifest, ThatIsRefusedLeavesNothingBehind) {
  const std::pair<const char*, std::string> refused[] = {
      {"is defined twice, and not alike: its version",
       with_lots([](json& all) { named(all["types"], "Segment")["version"] = 2; })},
      {"item kind 'segment' is defined twice",
       with_lots([](json& all) { named(all["kinds"], "segment")["ends"] = "edge"; })},
      {"type 'test.Lot' is defined twice", with_lots([](json& all) {
         all["types"].push_back(named(all["types"], "test.Lot"));
         all["types"].back()["layout"] = "2/2";
       })},
      {"item kind 'test.lot' is defined twice", with_lots([](json& all) {
         all["kinds"].push_back(named(all["kinds"], "test.lot"));
         all["kinds"].back()["transient"] = true;
       })},
      {"item kind 'test.shard' is named and not defined",
       with_lots([](json& all) { named(all["types"], "Metrics")["items"] = "test.shard"; })},
      {"type 'test.Shard' is named and not defined",
       with_lots([](json& all) { all["steps"][0]["outputs"][0]["type"] = "test.Shard"; })},
      {"'all' is unknown here",
       with_lots([](json& all) { all["steps"][0]["inputs"][0]["access"] = "all"; })},
      {"a whole number",
       with_lots([](json& all) { all["steps"][0]["parameters"][0]["default"] = 5.5; })},
      {"'summary' not found", with_lots([](json& all) { all["steps"][0].erase("summary"); })},
      {"'steps' not found", with_lots([](json& all) { all.erase("steps"); })}};
  for (const auto& [told, text] : refused) {
    EXPECT_THAT(refusal_of(text), HasSubstr(told));
    EXPECT_EQ(find_kind("test.lot"), nullptr) << told;
    EXPECT_EQ(find_type("test.Lot"), nullptr) << told;
  }
  EXPECT_EQ(refusal_of(with_lots([](json&) {})), "(nothing was refused)");
  EXPECT_EQ(find_type("test.Lot")->kind, find_kind("test.lot"));
}

TEST(Manifest, MayDefineWhatAnotherDefines) {
  const auto defining = [](const char* layout, const std::string& more) {
    return changed([&](json& all) {
      for (const std::string& name : {std::string("test.Shared"), more}) {
        all["types"].push_back(named(all["types"], "Metrics"));
        all["types"].back()["name"] = name;
        all["types"].back()["layout"] = layout;
      }
    });
  };
  EXPECT_EQ(refusal_of(defining("8/8", "test.First")), "(nothing was refused)");
  const Type* shared = find_type("test.Shared");
  EXPECT_EQ(refusal_of(defining("8/8", "test.Second")), "(nothing was refused)");
  EXPECT_EQ(find_type("test.Shared"), shared);
  EXPECT_NE(find_type("test.Second"), nullptr);
  EXPECT_THAT(refusal_of(defining("4/4", "test.Third")),
              HasSubstr("its layout in memory is 8/8 there and 4/4 here"));
  EXPECT_EQ(find_type("test.Third"), nullptr);
}

TEST(Manifest, OfAnotherAbiIsReadNoFurther) {
  const std::string text = changed([](json& all) {
    all["abi"] = "plumb-sdk 0";
    named(all["types"], "Metrics")["name"] = "test.Foreign";
    named(all["types"], "Segment")["version"] = 2;
  });
  const Manifest manifest = read_manifest(text, "small.json");
  EXPECT_EQ(manifest.abi_tag, "plumb-sdk 0");
  EXPECT_TRUE(manifest.steps.empty());
  EXPECT_EQ(manifest.licence.text(), "BSD-3-Clause AND Zlib");
  EXPECT_EQ(find_type("test.Foreign"), nullptr);
}

}  // namespace
}  // namespace plumb
