#include "plumb/slam/report/stages.hpp"

namespace plumb {

std::vector<std::string> stages_of(const PlannedStep& step) {
  std::vector<std::string> stages;
  for (std::size_t p = 0; p < step.inputs.size(); ++p)
    if (step.description->inputs[p].access == Access::several)
      for (const Wire& wire : step.inputs[p]) stages.push_back(wire.label);
  return stages;
}

bool is_of_stage(const std::string& number, const std::string& stage) {
  return number == stage || number.starts_with(stage + ".");
}

}  // namespace plumb
