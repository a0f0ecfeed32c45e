#include "plumb/slam/experiment/replicate.hpp"

#include <algorithm>

#include "plumb/data/hash.hpp"
#include "plumb/data/random.hpp"

namespace plumb::experiment {
namespace {

/// A parameter that is set where a step has it.
struct Disturbed {
  std::string parameter;
  ParameterKind kind;
  std::string value;
};

std::vector<Disturbed> drawn(const Replicates& replicates, std::size_t replicate,
                             const std::string& input) {
  constexpr std::uint32_t numbers = 1000000, most_phase = 50;  // [%]
  Random random(reseeded(reseeded(replicates.seed, replicate), hash_of(input).low));
  // All are drawn, whatever is disturbed: so none depends on the others.
  const std::uint32_t skipped = random.below(replicates.skip_frames + 1);
  const std::uint32_t drop_seed = 1 + random.below(numbers);
  const std::uint32_t phase = random.below(most_phase + 1);
  const std::uint32_t seed = 1 + random.below(numbers);
  std::vector<Disturbed> all;
  if (replicates.skip_frames > 0)
    all.push_back({"skip_frames", ParameterKind::integer, std::to_string(skipped)});
  if (replicates.drop_frames > 0) {
    all.push_back(
        {"drop_frames", ParameterKind::number, written(replicates.drop_frames, Quantity::ratio)});
    all.push_back({"drop_seed", ParameterKind::integer, std::to_string(drop_seed)});
  }
  if (replicates.phase)
    all.push_back({"phase", ParameterKind::number, std::to_string(phase) + "%"});
  if (replicates.seeds) all.push_back({"seed", ParameterKind::integer, std::to_string(seed)});
  return all;
}

bool has(const PlannedStep& step, const Disturbed& disturbed) {
  const ParameterDescription* parameter = step.description->parameter(disturbed.parameter);
  return parameter && parameter->kind == disturbed.kind;
}

}  // namespace

std::vector<std::string> disturbances(const Replicates& replicates, std::size_t replicate,
                                      const std::string& input, const Plan& plan) {
  std::vector<std::string> sets;
  if (replicate == 0) return sets;
  for (const Disturbed& disturbed : drawn(replicates, replicate, input))
    for (const PlannedStep& step : plan.steps)
      if (has(step, disturbed))
        sets.push_back(step.path + "." + disturbed.parameter + "=" + disturbed.value);
  return sets;
}

std::vector<std::string> not_disturbed(const Replicates& replicates, const Plan& plan) {
  std::vector<std::string> names;
  for (const Disturbed& disturbed : drawn(replicates, 1, ""))
    if (std::ranges::none_of(plan.steps,
                             [&](const PlannedStep& step) { return has(step, disturbed); }))
      names.push_back(disturbed.parameter);
  return names;
}

}  // namespace plumb::experiment
