#include <cmath>
#include <cstdio>

#include "plumb/data/counted.hpp"
#include "plumb/data/short_number.hpp"
#include "plumb/slam/experiment/outcome.hpp"

namespace plumb::experiment {
namespace {

struct Words {
  const char *verb, *lower, *higher;
};

Words words_for(const Judged& number) {
  if (number.unit == "s" || number.unit == "CPU s") return {"takes", "less", "more"};
  if (number.unit.empty()) return {"has", "less", "more"};
  return {"is", "lower", "higher"};
}

/// "120", "12", "3.4", "3", "0.21".
std::string rounded(double value) {
  constexpr double two_digits = 9.95;
  char text[32];
  std::snprintf(text, sizeof text, value >= two_digits ? "%.0f" : "%.2g", value);
  return text;
}

/// How far a contrast is from 0, as people say it, without the unit: percent for ratios.
std::string size_of(const Judged& number, double contrast) {
  return number.scale == Scale::ratio ? rounded(100 * std::abs(std::expm1(contrast)))
                                      : short_number(std::abs(contrast));
}

std::string unit_of(const Judged& number) {
  if (number.scale == Scale::ratio) return " %";
  return number.unit.empty() ? "" : " " + number.unit;
}

std::string interval_text(const Judged& number, const Interval& interval) {
  const Words words = words_for(number);
  const std::string unit = unit_of(number);
  const std::string low = size_of(number, interval.low), high = size_of(number, interval.high);
  if (interval.low < 0 && interval.high > 0)
    return low + unit + " " + words.lower + " to " + high + unit + " " + words.higher;
  return interval.low < 0 ? high + " to " + low + unit : low + " to " + high + unit;
}

}  // namespace

std::string amount(const Judged& number, double contrast) {
  return size_of(number, contrast) + unit_of(number);
}

std::string effect(const Judged& number, const Contrast& contrast, const std::string& reference) {
  if (contrast.by_input.empty()) return "nothing to hold against " + reference;
  if (contrast.method == Method::identical) return "the same as " + reference;
  const Words words = words_for(number);
  std::string text = amount(number, contrast.estimate) + " " +
                     (contrast.estimate < 0 ? words.lower : words.higher) + " than " + reference;
  if (contrast.interval) text += " (" + interval_text(number, *contrast.interval) + ")";
  return text;
}

std::string verdict_words(const Contrast& contrast, std::size_t inputs) {
  if (contrast.verdict == Verdict::fails)
    return "no result on " + std::to_string(contrast.failed_inputs) + " of " +
           counted(inputs, "inputs");
  std::string words = name_of(contrast.verdict);
  if (contrast.method == Method::segments || contrast.method == Method::replicates)
    words += ", on these data";
  return words;
}

std::string sentence(const Judged& number, const Contrast& contrast, const std::string& reference,
                     std::size_t inputs) {
  const bool nothing = contrast.by_input.empty();
  return contrast.variant + " " + (nothing ? "gives" : words_for(number).verb) + " " +
         effect(number, contrast, reference) + ": " + verdict_words(contrast, inputs);
}

std::string reference_of(const Outcome& outcome) {
  if (!outcome.baseline.empty()) return "in " + outcome.baseline;
  return outcome.measured.variants.empty() ? "" : outcome.measured.variants.front();
}

}  // namespace plumb::experiment
