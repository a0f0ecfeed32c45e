#include "metrics.hpp"

#include <gmock/gmock.h>

#include <limits>
#include <nlohmann/json.hpp>

namespace plumb::write_metrics {
namespace {

Metrics sample() {
  Metrics metrics;
  metrics.add("residual", 0.1, "m")
      .add("worst", 1.0 / 3, "m")
      .add("none", std::numeric_limits<double>::quiet_NaN(), "m");
  metrics.edges = {{0, 1, EdgeKind::sequential, 900, 120, 0.05, 0.99, "accepted"},
                   {0, 7, EdgeKind::loop, 800, 30, 5.5, 0.01, "rejected"},
                   {3, 9, EdgeKind::neighbour, 700, 0, 0, 0, "no matches"}};
  metrics.notes = {"segments 4 are \"weak\""};
  return metrics;
}

TEST(MetricsJson, HoldsStagesNumbersNotesAndEdges) {
  const auto metrics = sample();
  const auto json = nlohmann::json::parse(metrics_json({{"drift", &metrics}, {"fine", &metrics}}));
  ASSERT_EQ(json["stages"].size(), 2u);
  const auto& stage = json["stages"][0];
  EXPECT_EQ(stage["stage"], "drift");
  EXPECT_EQ(stage["numbers"]["worst"]["value"].get<double>(), 1.0 / 3);
  EXPECT_EQ(stage["numbers"]["residual"]["unit"], "m");
  EXPECT_TRUE(stage["numbers"]["none"]["value"].is_null());
  EXPECT_EQ(stage["notes"][0], "segments 4 are \"weak\"");
  ASSERT_EQ(stage["edges"].size(), 3u);
  EXPECT_EQ(stage["edges"][1]["kind"], "loop");
  EXPECT_EQ(stage["edges"][1]["status"], "rejected");
  EXPECT_EQ(stage["edges"][1]["found"], 800);
  EXPECT_EQ(stage["edges"][1]["residual"].get<double>(), 5.5);
}

TEST(MetricsJson, KeepsItsKeysInOneOrderAndAnEdgeALine) {
  const auto metrics = sample();
  const auto text = metrics_json({{"", &metrics}});
  EXPECT_THAT(
      text,
      testing::HasSubstr(
          R"({"i":0,"j":7,"kind":"loop","found":800,"kept":30,"residual":5.5,"weight":0.01,"status":"rejected"})"));
  EXPECT_LT(text.find("\"residual\""), text.find("\"worst\""));
  EXPECT_EQ(text, metrics_json({{"", &metrics}}));
}

TEST(MetricsJson, IsValidWithoutAnything) {
  const Metrics empty;
  EXPECT_TRUE(nlohmann::json::parse(metrics_json({}))["stages"].empty());
  EXPECT_TRUE(nlohmann::json::parse(metrics_json({{"a", &empty}}))["stages"][0]["edges"].empty());
}

}  // namespace
}  // namespace plumb::write_metrics
