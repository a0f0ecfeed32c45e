#pragma once
/// For tests of the order of steps: plans that are nothing but who draws on whom.

#include <list>
#include <string>
#include <vector>

#include "plumb/pipeline/bind/plan.hpp"

namespace plumb::engine_test {

/// Steps by their numbers, each of a kind of its own with one input.
struct DrawnPlan {
  std::list<StepDescription> descriptions;
  Plan plan;

  void add(const std::vector<int>& from) {
    descriptions.emplace_back().inputs.resize(1);
    PlannedStep step;
    step.path = std::to_string(plan.steps.size());
    step.description = &descriptions.back();
    step.inputs.resize(1);
    for (const int s : from) step.inputs[0].emplace_back().step = s;
    plan.steps.push_back(std::move(step));
  }
  /// Makes two of one kind, whose parameter is 1 of `other`.
  void make_alike(int step, int other, std::int64_t value) {
    StepDescription& kind = descriptions.emplace_back();
    kind.inputs.resize(1);
    kind.parameters.emplace_back().name = "n";
    for (const int s : {step, other}) {
      plan.steps[s].description = &kind;
      plan.steps[s].parameters.resize(1);
    }
    plan.steps[step].parameters[0].value = value;
    plan.steps[other].parameters[0].value = std::int64_t{1};
  }
};

}  // namespace plumb::engine_test
