#pragma once
/// Several variants of a pipeline on the same inputs, number by number.

#include <optional>
#include <string>
#include <vector>

#include "plumb/engine/run/runner.hpp"

namespace plumb {

struct ComparedFigures {
  /// Globs (fnmatch) over "STEP.NUMBER", as in "error.*.ate". None: all numbers of steps called
  /// error, map_error and relation_error; where these measure several stages, of the last one.
  std::vector<std::string> metrics;
  /// Steps whose names begin so are what is timed and whose iterations count.
  std::vector<std::string> timed = {"register.", "track."};
};

/// The numbers of one run that are compared, named "STEP.NUMBER": those chosen; then CPU time and
/// iterations (where counted) of the timed steps; last `time`, CPU time of all steps. Numbers
/// that are non-finite are left out. Throws Error, if it `must_match`: a glob that no number
/// matches.
std::vector<Number> figures_of(const Plan& plan, const RunResult& result,
                               const ComparedFigures& chosen, bool must_match = true);

/// How much less the first variant has than another: 100 (1 - mean of the first / mean of the
/// other) [%].
struct Less {
  double percent = 0;              ///< NaN where the other's mean is 0
  std::optional<double> interval;  ///< half the 95 % confidence interval of `percent`: Student's t
                                   ///< over the inputs' differences
};

/// One number over all runs.
struct ComparedNumber {
  std::string name, unit;
  std::vector<std::size_t>
      inputs;  ///< those where every variant that gives it anywhere gives it, ascending
  std::vector<std::vector<double>>
      values;  ///< by variant, then as `inputs`; none of a variant that never gives it

  double mean(std::size_t variant) const;  ///< NaN for none
  Less less_than(std::size_t variant) const;
};

struct Comparison {
  std::vector<std::string> variants,
      inputs;  ///< names; the first variant is what the others are held against
  std::vector<ComparedNumber> numbers;  ///< those that the first variant and another give; on one
                                        ///< input at least all that give them
};

/// `figures`: by variant, then input. Rows keep the order of the first run that has them.
Comparison compare(std::vector<std::string> variants, std::vector<std::string> inputs,
                   const std::vector<std::vector<std::vector<Number>>>& figures);

/// Two-sided 95 % point of Student's t, to 1e-3. `freedom` is at least 1.
double student_t(std::size_t freedom);

/// As one JSON object (NaN is null), and as a table for people.
std::string comparison_json(const Comparison& comparison);
std::string comparison_table(const Comparison& comparison);

}  // namespace plumb
