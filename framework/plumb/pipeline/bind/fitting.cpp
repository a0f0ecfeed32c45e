#include "plumb/pipeline/bind/fitting.hpp"

#include <algorithm>

namespace plumb::pipeline {
namespace {

/// Which grains an input takes: item kinds, or null for one value of the pipeline. None: any kind.
std::vector<const ItemKind*> grains_for(const StepDescription& step,
                                        const InputDescription& input) {
  switch (input.access) {
    case Access::ends:
      return {step.items ? find_kind(step.items->ends) : nullptr};
    case Access::each:
      if (!step.items) return {};
      return {find_kind(step.items->parts)};
    case Access::several:
    case Access::part:
      return {nullptr};
    case Access::item:
      break;
  }
  if (!step.items || !input.type->kind) return {nullptr};
  return {step.items, nullptr};
}

}  // namespace

bool fits(const StepDescription& step, const InputDescription& input, const Source& source) {
  if (source.type != input.type) return false;
  const auto grains = grains_for(step, input);
  if (grains.empty()) return source.grain != nullptr;
  return std::find(grains.begin(), grains.end(), source.grain) != grains.end();
}

std::string wanted(const StepDescription& step, const InputDescription& input) {
  const auto grains = grains_for(step, input);
  const bool own =
      grains.empty() || std::find(grains.begin(), grains.end(), input.type->kind) != grains.end();
  std::string text = kind_of(*input.type, own ? input.type->kind : grains.front());
  if (input.access == Access::several) text += ", any number of them";
  return text;
}

}  // namespace plumb::pipeline
