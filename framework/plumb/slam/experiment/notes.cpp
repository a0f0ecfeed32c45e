/// What stands below the tables.
#include <algorithm>

#include "plumb/data/counted.hpp"
#include "plumb/data/short_number.hpp"
#include "plumb/slam/experiment/outcome.hpp"

namespace plumb::experiment {
namespace {

std::string percent(double share) { return short_number(100 * share) + " %"; }

bool has(const Outcome& outcome, Method method) {
  return std::ranges::any_of(outcome.numbers, [&](const Judged& number) {
    return std::ranges::any_of(number.contrasts,
                               [&](const Contrast& c) { return c.method == method; });
  });
}

bool has_cached(const Outcome& outcome) {
  return std::ranges::any_of(outcome.measured.cells, [](const Cell& cell) {
    return std::ranges::any_of(cell.figures, [](const Figure& f) { return f.from_cache; });
  });
}

/// What could have been shown of the number that decides.
std::string power_of(const Outcome& outcome, const Judged& primary) {
  std::size_t inputs = outcome.measured.inputs.size();
  double least_p = 0;
  const Contrast* widest = nullptr;
  for (const Contrast& c : primary.contrasts) {
    inputs = std::min(inputs, c.inputs.size());
    least_p = std::max(least_p, c.least_p);
    if (c.least_shown && (!widest || *c.least_shown > *widest->least_shown)) widest = &c;
  }
  const std::size_t variants = primary.contrasts.size();
  std::string text = "With " + counted(inputs, "inputs") + " and " + counted(variants, "variants") +
                     " the smallest p that could be reached is " + short_number(least_p);
  const std::size_t needed = differences_needed(outcome.rules.alpha, variants);
  if (inputs < needed)
    text += ": a statement beyond these data needs " + std::to_string(needed) + " inputs";
  if (!widest) return text + ".";
  return text + "; a difference of " + amount(primary, *widest->least_shown) +
         " could have been shown" + (widest->on_these_data() ? " on these data." : ".");
}

std::string intervals_of(const Outcome& outcome) {
  std::string text = "Intervals: 95 %";
  if (has(outcome, Method::sign_flip)) text += ", by the exact sign-flip test over the inputs";
  if (has(outcome, Method::segments))
    text += ", by " + std::to_string(outcome.rules.draws) +
            " draws of the segments with all their edges or frames (seed " +
            std::to_string(outcome.rules.seed) + ")";
  if (has(outcome, Method::replicates))
    text += ", by " + std::to_string(outcome.rules.draws) + " draws of the replicates (seed " +
            std::to_string(outcome.rules.seed) + ")";
  return text + ".";
}

}  // namespace

std::vector<std::string> notes_of(const Outcome& outcome) {
  const Measured& m = outcome.measured;
  std::vector<std::string> notes;
  if (const Judged* primary = outcome.primary()) {
    notes.push_back(primary->name +
                    " decides: " + (primary->higher_is_better ? "higher" : "lower") +
                    " is better, up to " + percent(outcome.rules.margin) +
                    " is equivalent. All other numbers are exploratory.");
    if (!primary->contrasts.empty()) notes.push_back(power_of(outcome, *primary));
    if (primary->contrasts.size() > 1 && has(outcome, Method::sign_flip))
      notes.push_back("Its verdicts are adjusted for " +
                      counted(primary->contrasts.size(), "variants") + " (Holm).");
  }
  if (has(outcome, Method::sign_flip) || has(outcome, Method::segments) ||
      has(outcome, Method::replicates))
    notes.push_back(intervals_of(outcome));
  if (m.replicates > 1)
    notes.push_back(counted(m.replicates, "replicates") + " an input (seed " +
                    std::to_string(outcome.replicates.seed) +
                    "), disturbed alike for all variants; a run gives the same each time.");
  if (has_cached(outcome))
    notes.push_back(
        "* was spent in part in earlier runs or by another variant, and is not compared: "
        "--cache-dir none measures it.");
  for (std::size_t v = 0; v < m.variants.size(); ++v)
    for (std::size_t k = 0; k < m.inputs.size(); ++k)
      for (std::size_t r = 0; r < m.replicates; ++r)
        if (const std::string& failure = m.at(v, k, r).failure; !failure.empty())
          notes.push_back("failed: variant '" + m.variants[v] + "' on " + m.inputs[k].name +
                          (m.replicates > 1 ? ", replicate " + std::to_string(r + 1) : "") + ": " +
                          failure);
  return notes;
}

}  // namespace plumb::experiment
