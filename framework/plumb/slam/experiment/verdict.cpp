#include "plumb/slam/experiment/verdict.hpp"

#include <fnmatch.h>

#include <algorithm>
#include <cmath>

namespace plumb::experiment {
namespace {

/// One variant's cells.
struct Side {
  const Measured* measured;
  std::size_t variant;

  const Cell& at(std::size_t input, std::size_t replicate) const {
    return measured->at(variant, input, replicate);
  }
};

/// The runs of two variants in which both gave a number.
struct Pairing {
  std::vector<std::size_t> inputs;
  std::vector<std::vector<RunPair>> pairs;  ///< as `inputs`
  std::size_t failed_inputs = 0;
};

/// Of each input of `b` the one of `a` that it is held against; none for no such.
using InputMap = std::vector<std::optional<std::size_t>>;

RunPair pair_of(const Figure& a, const Figure& b) {
  const auto known = [](const SegmentSums& sums) { return sums.size() > 0 ? &sums : nullptr; };
  return {a.number.value, b.number.value, known(a.segments), known(b.segments)};
}

Pairing paired(const std::string& number, const Side& a, const Side& b,
               const InputMap& input_of_a) {
  Pairing pairing;
  const std::size_t replicates = std::min(a.measured->replicates, b.measured->replicates);
  for (std::size_t k = 0; k < input_of_a.size(); ++k) {
    if (!input_of_a[k]) continue;
    std::vector<RunPair> runs;
    bool failed = false;
    for (std::size_t r = 0; r < replicates; ++r) {
      const Figure* of_a = a.at(*input_of_a[k], r).find(number);
      const Figure* of_b = b.at(k, r).find(number);
      failed = failed || (of_a && !of_b);
      if (of_a && of_b && !of_a->from_cache && !of_b->from_cache)
        runs.push_back(pair_of(*of_a, *of_b));
    }
    pairing.failed_inputs += failed;
    if (runs.empty()) continue;
    pairing.inputs.push_back(k);
    pairing.pairs.push_back(std::move(runs));
  }
  return pairing;
}

/// Whether it gave the number anywhere, or might have: a run failed.
bool may_give(const Side& side, const std::string& number) {
  const Measured& m = *side.measured;
  for (std::size_t k = 0; k < m.inputs.size(); ++k)
    for (std::size_t r = 0; r < m.replicates; ++r)
      if (side.at(k, r).find(number) || !side.at(k, r).failure.empty()) return true;
  return false;
}

bool gives(const Side& side, const std::string& number) {
  const Measured& m = *side.measured;
  for (std::size_t k = 0; k < m.inputs.size(); ++k)
    for (std::size_t r = 0; r < m.replicates; ++r)
      if (side.at(k, r).find(number)) return true;
  return false;
}

bool all_positive(const Measured& measured, const std::string& number) {
  return std::ranges::all_of(measured.cells, [&](const Cell& cell) {
    const Figure* figure = cell.find(number);
    return !figure || figure->number.value > 0;
  });
}

bool matches(const std::vector<std::string>& globs, const std::string& name) {
  return std::ranges::any_of(
      globs, [&](const std::string& glob) { return fnmatch(glob.c_str(), name.c_str(), 0) == 0; });
}

/// Names, scale and direction, without the contrasts.
std::vector<Judged> judged_numbers(const Measured& now, const Measured* then, const Rules& rules) {
  std::vector<Judged> all;
  for (const Number& number : numbers_in(now)) {
    const bool ratio = !number.unit.empty() && all_positive(now, number.name) &&
                       (!then || all_positive(*then, number.name));
    all.push_back({number.name, number.unit, ratio ? Scale::ratio : Scale::difference,
                   number.name == rules.primary, matches(rules.higher_is_better, number.name)});
  }
  return all;
}

double mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

/// How far from 0 a contrast is still equivalent.
double margin_of(const Pairing& pairing, Scale scale, double margin) {
  if (scale == Scale::ratio) return std::log1p(margin);
  std::vector<double> of_a;
  for (const auto& runs : pairing.pairs) {
    std::vector<double> values;
    for (const RunPair& run : runs) values.push_back(run.a);
    of_a.push_back(mean(values));
  }
  return margin * std::abs(mean(of_a));
}

Contrast contrast_of(const Pairing& pairing, Scale scale, const Rules& rules) {
  Contrast made;
  made.inputs = pairing.inputs;
  made.failed_inputs = pairing.failed_inputs;
  bool identical = true;
  for (const auto& runs : pairing.pairs) {
    std::vector<double> contrasts;
    for (const RunPair& run : runs) contrasts.push_back(contrast(scale, run.a, run.b));
    identical = identical && std::ranges::all_of(contrasts, [](double c) { return c == 0; });
    made.by_input.push_back(mean(contrasts));
  }
  if (made.by_input.empty()) return made;
  made.estimate = mean(made.by_input);
  const std::size_t n = made.by_input.size();
  made.least_p = std::min(1.0, std::ldexp(2.0, -static_cast<int>(std::min<std::size_t>(n, 60))));
  if (identical) {
    made.interval = Interval{0, 0};
    made.method = Method::identical;
  } else if (n >= differences_needed(rules.alpha, 1)) {
    const SignFlip test(made.by_input);
    made.method = Method::sign_flip;
    made.interval = test.interval(rules.alpha);
    made.p = test.p();
    made.least_p = test.least_p();
  } else {
    const auto found = bootstrap(pairing.pairs, scale, rules.draws, rules.seed, rules.alpha);
    if (found.resampled == Resampled::nothing) return made;
    made.method = found.resampled == Resampled::segments ? Method::segments : Method::replicates;
    made.interval = found.interval;
  }
  return made;
}

double half_width(const Interval& interval, double estimate) {
  return std::max(estimate - interval.low, interval.high - estimate);
}

/// Adjusts what was tested for the number of variants, and says what could have been shown.
void adjust(Judged& judged, const Rules& rules) {
  std::vector<double> p;  // 1 of what was not tested: it is a comparison all the same
  for (const Contrast& c : judged.contrasts) p.push_back(c.p.value_or(1));
  const std::vector<double> adjusted = judged.primary ? holm(p) : p;
  const auto comparisons = judged.primary ? static_cast<double>(judged.contrasts.size()) : 1.0;
  for (std::size_t k = 0; k < judged.contrasts.size(); ++k) {
    Contrast& c = judged.contrasts[k];
    c.least_p = std::min(1.0, c.least_p * comparisons);
    if (c.p) {
      c.adjusted_p = adjusted[k];
      if (const auto wide = SignFlip(c.by_input).interval(rules.alpha / comparisons))
        c.least_shown = half_width(*wide, c.estimate);
    } else if (c.interval && c.method != Method::identical) {
      c.least_shown = half_width(*c.interval, c.estimate);
    }
  }
}

Verdict verdict_of(const Contrast& c, double margin, bool higher_is_better, double alpha) {
  if (c.by_input.empty()) return Verdict::fails;
  const double worse = higher_is_better ? -c.estimate : c.estimate;
  Verdict verdict = std::abs(worse) > margin ? Verdict::large : Verdict::not_shown;
  if (c.interval) {
    const double low = higher_is_better ? -c.interval->high : c.interval->low;
    const double high = higher_is_better ? -c.interval->low : c.interval->high;
    const bool shown = !c.adjusted_p || *c.adjusted_p <= alpha;
    if (low >= -margin && high <= margin)
      verdict = Verdict::equivalent;
    else if (low > 0 && shown)
      verdict = Verdict::worse;
    else if (high < 0 && shown)
      verdict = Verdict::better;
  }
  return c.failed_inputs > 0 && verdict != Verdict::worse ? Verdict::fails : verdict;
}

/// Adds the contrasts of some variants, each against its reference.
void add_contrasts(Judged& judged, const std::vector<std::pair<Side, Side>>& sides,
                   const InputMap& input_of_a, const Rules& rules) {
  std::vector<double> margins;
  for (const auto& [a, b] : sides) {
    if (!gives(a, judged.name) || !may_give(b, judged.name)) continue;
    const Pairing pairing = paired(judged.name, a, b, input_of_a);
    if (pairing.pairs.empty() && pairing.failed_inputs == 0) continue;
    judged.contrasts.push_back(contrast_of(pairing, judged.scale, rules));
    judged.contrasts.back().variant = b.measured->variants[b.variant];
    margins.push_back(pairing.pairs.empty() ? 0 : margin_of(pairing, judged.scale, rules.margin));
  }
  adjust(judged, rules);
  for (std::size_t k = 0; k < margins.size(); ++k)
    judged.contrasts[k].verdict =
        verdict_of(judged.contrasts[k], margins[k], judged.higher_is_better, rules.alpha);
}

}  // namespace

const char* name_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::better:
      return "better";
    case Verdict::worse:
      return "worse";
    case Verdict::equivalent:
      return "equivalent";
    case Verdict::not_shown:
      return "not shown";
    case Verdict::large:
      return "large, not proven";
    case Verdict::fails:
      return "fails";
  }
  return "?";
}

std::vector<Judged> judge(const Measured& measured, const Rules& rules) {
  InputMap same;
  for (std::size_t k = 0; k < measured.inputs.size(); ++k) same.emplace_back(k);
  const Side first{&measured, 0};
  std::vector<Judged> all;
  for (Judged& judged : judged_numbers(measured, nullptr, rules)) {
    if (measured.variants.empty() || !gives(first, judged.name)) continue;
    std::vector<std::pair<Side, Side>> sides;
    bool any = false;
    for (std::size_t v = 1; v < measured.variants.size(); ++v) {
      sides.push_back({first, {&measured, v}});
      any = any || may_give({&measured, v}, judged.name);
    }
    if (!any) continue;
    add_contrasts(judged, sides, same, rules);
    all.push_back(std::move(judged));
  }
  return all;
}

std::vector<Judged> judge_against(const Measured& then, const Measured& now, const Rules& rules) {
  InputMap input_of_then;
  for (const InputSize& input : now.inputs) {
    const auto at = std::ranges::find(then.inputs, input);
    input_of_then.push_back(at == then.inputs.end() ? std::nullopt
                                                    : std::optional(static_cast<std::size_t>(
                                                          at - then.inputs.begin())));
  }
  std::vector<std::pair<Side, Side>> sides;
  for (std::size_t v = 0; v < now.variants.size(); ++v) {
    const auto at = std::ranges::find(then.variants, now.variants[v]);
    if (at != then.variants.end())
      sides.push_back({{&then, static_cast<std::size_t>(at - then.variants.begin())}, {&now, v}});
  }
  std::vector<Judged> all;
  for (Judged& judged : judged_numbers(now, &then, rules)) {
    if (judged.unit == "CPU s") continue;  // of another machine, or another day
    add_contrasts(judged, sides, input_of_then, rules);
    if (!judged.contrasts.empty()) all.push_back(std::move(judged));
  }
  return all;
}

Standing standing(const Measured& measured, std::size_t variant, std::size_t input,
                  const Judged& number) {
  Standing made;
  std::vector<double> values;
  for (std::size_t r = 0; r < measured.replicates; ++r)
    if (const Figure* figure = measured.at(variant, input, r).find(number.name)) {
      values.push_back(figure->number.value);
      made.from_cache = made.from_cache || figure->from_cache;
    }
  made.value = mean_of(values, number.scale);
  return made;
}

std::optional<double> mean_of(const std::vector<double>& values, Scale scale) {
  if (values.empty()) return std::nullopt;
  double sum = 0;
  for (const double value : values) sum += scale == Scale::ratio ? std::log(value) : value;
  sum /= static_cast<double>(values.size());
  return scale == Scale::ratio ? std::exp(sum) : sum;
}

}  // namespace plumb::experiment
