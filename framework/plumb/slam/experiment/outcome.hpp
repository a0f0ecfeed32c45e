#pragma once
/// What an experiment found, for people and for programs.

#include <filesystem>
#include <string>
#include <vector>

#include "plumb/slam/experiment/experiment.hpp"
#include "plumb/slam/experiment/verdict.hpp"

namespace plumb::experiment {

struct Outcome {
  std::string name, about;  ///< of the experiment
  Measured measured;
  Rules rules;
  Replicates replicates;
  std::vector<Judged> numbers;  ///< against the first variant, or against `baseline`
  std::string baseline;         ///< file of an earlier outcome; empty for none
  std::vector<std::vector<std::pair<std::string, std::string>>> swept;  ///< by variant

  /// The number that decides; null where no two gave it.
  const Judged* primary() const;
  /// Whether some variant has this verdict by that number.
  bool any(Verdict verdict) const;
};

/// "coarse is 12 % lower than plumb (3 to 20 %): better, on these data". `reference` is what stands
/// behind "than".
std::string sentence(const Judged& number, const Contrast& contrast, const std::string& reference,
                     std::size_t inputs);
/// Of that the middle: "12 % lower than plumb (3 to 20 %)".
std::string effect(const Judged& number, const Contrast& contrast, const std::string& reference);
/// And its end: "better, on these data".
std::string verdict_words(const Contrast& contrast, std::size_t inputs);
/// How far a contrast is from 0, without its direction: "12 %", "0.3 m".
std::string amount(const Judged& number, double contrast);
/// What stands behind "than" in an outcome's sentences.
std::string reference_of(const Outcome& outcome);
/// How intervals were found, what could have been shown, what failed: a sentence each.
std::vector<std::string> notes_of(const Outcome& outcome);
/// "0.0123", "0.0123*" of a cache, "failed", "-".
std::string cell_text(const Outcome& outcome, std::size_t variant, std::size_t input,
                      const Judged& number);
/// Over all inputs of which each variant of the number has a value to compare; "-" for none.
std::string mean_text(const Outcome& outcome, std::size_t variant, const Judged& number);

/// For a terminal: rows by input, a sentence a variant.
std::string outcome_table(const Outcome& outcome);
/// The same for a page.
std::string outcome_markdown(const Outcome& outcome);
/// A plot of the number that decides: a row a variant, its mean, interval and inputs.
std::string outcome_svg(const Outcome& outcome);
/// A line for each number of each run: variant, input, replicate, metric, value, unit, cached,
/// failed, and what a sweep set.
std::string outcome_csv(const Outcome& outcome);
/// All of it: what outcome_of_json reads back, and the verdicts.
std::string outcome_json(const Outcome& outcome);

/// Reads what outcome_json wrote, but for the verdicts. Throws Error: it is none.
Outcome outcome_of_json(const std::filesystem::path& file);

/// The variants and inputs of an outcome that another has not: "variant ratio2", "input in4".
/// Inputs are the same by name, number of files and bytes.
std::vector<std::string> only_in(const Outcome& outcome, const Outcome& other);

/// Why `now` cannot be held against `then`, as the end of a sentence; empty when it can be: another
/// primary number, replicates that disturb otherwise, a variant or an input that `then` has not.
std::string not_comparable(const Outcome& then, const Outcome& now);

}  // namespace plumb::experiment
