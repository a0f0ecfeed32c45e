#include "plumb/plugin/manifest.hpp"

#include <gmock/gmock.h>

#include "plumb/data/error.hpp"

namespace plumb {
namespace {

using testing::HasSubstr;

/// A step of version 7 with a whole parameter whose default is 5, in a module with zlib.
Manifest small_manifest() {
  StepDescription step;
  step.name = "test.small";
  step.version = 7;
  ParameterDescription count;
  count.name = "count";
  count.kind = ParameterKind::integer;
  count.standard = std::int64_t{5};
  step.parameters = {count};
  return {"abi", {step}, {"BSD-3-Clause AND Zlib", "zlib is Zlib."}};
}

std::string with(const std::string& old, const std::string& fresh) {
  std::string text = manifest_text(small_manifest());
  return text.replace(text.find(old), old.size(), fresh);
}

std::string refusal_of(const std::string& text) {
  try {
    read_manifest(text, "small.json");
  } catch (const Error& error) {
    return error.what();
  }
  return "";
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
  EXPECT_EQ(refusal_of(with("\"default\": 5", "\"default\": -9223372036854775808")), "");
}

}  // namespace
}  // namespace plumb
