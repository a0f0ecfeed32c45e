#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <numbers>

#include "plumb/data/counted.hpp"
#include "plumb/slam/report/evaluation.hpp"

namespace plumb {
namespace {

double degrees(double radians) { return radians * 180 / std::numbers::pi; }

nlohmann::ordered_json json_of(const TrajectoryScore& score) {
  // NaN is written as null.
  nlohmann::ordered_json json{{"poses", score.poses},
                              {"ate_rmse", score.absolute.rmse},
                              {"ate_max", score.absolute.max},
                              {"rpe_m", score.relative.translation},
                              {"rpe_deg", degrees(score.relative.rotation)}};
  if (score.ghosting) {
    json["ghosting"] = score.ghosting->estimate;
    json["ghosting_truth"] = score.ghosting->truth;
    json["pairs"] = score.ghosting->pairs;
  }
  return json;
}

/// A number in a column, or a dash where there is none.
std::string cell(double value, int width, int decimals) {
  char text[64];
  if (std::isnan(value))
    std::snprintf(text, sizeof text, "%*s", width, "-");
  else
    std::snprintf(text, sizeof text, "%*.*f", width, decimals, value);
  return text;
}

std::string row(const char* name, const TrajectoryScore& score, std::size_t true_poses) {
  char text[80];
  const auto poses = std::to_string(score.poses) + "/" + std::to_string(true_poses);
  std::snprintf(text, sizeof text, "%-7s%13s", name, poses.c_str());
  std::string line = text + cell(score.absolute.rmse, 12, 3) + cell(score.absolute.max, 12, 3) +
                     cell(score.relative.translation, 12, 4) +
                     cell(degrees(score.relative.rotation), 12, 4);
  if (score.ghosting)
    line += cell(score.ghosting->estimate, 12, 3) + cell(score.ghosting->truth, 12, 3);
  return line + "\n";
}

}  // namespace

std::string evaluation_json(const Evaluation& evaluation) {
  nlohmann::ordered_json json;
  if (evaluation.before) json["before"] = json_of(*evaluation.before);
  json["after"] = json_of(evaluation.after);
  return json.dump();
}

std::string evaluation_table(const Evaluation& evaluation) {
  const auto& ghosting = evaluation.after.ghosting;
  std::string text = "               poses  ATE rmse/m   ATE max/m  RPE10m / m  RPE10m/deg";
  if (ghosting) text += "  ghosting/m  in truth/m";
  text += "\n";
  if (evaluation.before) text += row("before", *evaluation.before, evaluation.true_poses);
  text += row("after", evaluation.after, evaluation.true_poses);
  if (ghosting)
    text += "Ghosting over " + counted(ghosting->pairs, "pairs of frames") +
            " that see the same place twice.\n";
  return text;
}

}  // namespace plumb
