#include "plumb/slam/experiment/outcome.hpp"

#include <algorithm>

#include "plumb/data/short_number.hpp"
#include "plumb/pipeline/yaml/diagnostics.hpp"

namespace plumb::experiment {

const Judged* Outcome::primary() const {
  const auto at = std::ranges::find_if(
      numbers, [](const Judged& number) { return number.primary && !number.contrasts.empty(); });
  return at == numbers.end() ? nullptr : &*at;
}

bool Outcome::any(Verdict verdict) const {
  const Judged* decides = primary();
  return decides && std::ranges::any_of(decides->contrasts, [&](const Contrast& contrast) {
           return contrast.verdict == verdict;
         });
}

std::string cell_text(const Outcome& outcome, std::size_t variant, std::size_t input,
                      const Judged& number) {
  const Measured& m = outcome.measured;
  const Standing stands = standing(m, variant, input, number);
  if (stands.value) return short_number(*stands.value) + (stands.from_cache ? "*" : "");
  for (std::size_t r = 0; r < m.replicates; ++r)
    if (!m.at(variant, input, r).failure.empty()) return "failed";
  return "-";
}

std::string mean_text(const Outcome& outcome, std::size_t variant, const Judged& number) {
  const Measured& m = outcome.measured;
  std::vector<double> values;
  for (std::size_t k = 0; k < m.inputs.size(); ++k) {
    const auto has = [&](std::size_t v) {
      const Standing stands = standing(m, v, k, number);
      return stands.value && !stands.from_cache;
    };
    bool all = has(variant);
    for (const Contrast& contrast : number.contrasts)
      if (!contrast.by_input.empty())
        all = all && std::ranges::find(contrast.inputs, k) != contrast.inputs.end();
    if (all) values.push_back(*standing(m, variant, k, number).value);
  }
  const auto mean = mean_of(values, number.scale);
  return mean ? short_number(*mean) : "-";
}

std::vector<std::string> only_in(const Outcome& outcome, const Outcome& other) {
  const Measured &m = outcome.measured, &others = other.measured;
  std::vector<std::string> only;
  for (const std::string& variant : m.variants)
    if (std::ranges::find(others.variants, variant) == others.variants.end())
      only.push_back("variant " + variant);
  for (const InputSize& input : m.inputs)
    if (std::ranges::find(others.inputs, input) == others.inputs.end())
      only.push_back("input " + input.name);
  return only;
}

std::string not_comparable(const Outcome& then, const Outcome& now) {
  if (then.rules.primary != now.rules.primary)
    return "its number that decides is '" + then.rules.primary + "' and this one's '" +
           now.rules.primary + "'";
  const Replicates &a = then.replicates, &b = now.replicates;
  if (a.count != b.count || a.skip_frames != b.skip_frames || a.drop_frames != b.drop_frames ||
      a.phase != b.phase || a.seeds != b.seeds)
    return "its replicates disturb something else than these, or are others in number";
  const std::vector<std::string> unknown = only_in(now, then);
  if (unknown.empty()) return "";
  return "not in it: " + pipeline::joined(unknown) +
         " (by name, and of inputs by the number of files and bytes); leave them out, or make it "
         "anew with --save";
}

}  // namespace plumb::experiment
