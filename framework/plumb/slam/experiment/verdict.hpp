#pragma once
/// Which variant is better, by how much, and how sure that is.

#include <optional>
#include <string>
#include <vector>

#include "plumb/slam/experiment/measured.hpp"

namespace plumb::experiment {

enum class Verdict {
  better,
  worse,
  equivalent,  ///< the interval lies within the margin
  not_shown,   ///< neither better nor worse nor equivalent
  large,       ///< not shown either, but beyond the margin: more inputs may show it
  fails,       ///< gives no number on some input where the reference does
};
const char* name_of(Verdict verdict);  ///< "better", "not shown", "large, not proven"

/// How an interval was found.
enum class Method {
  none,        ///< there is no interval
  identical,   ///< all runs gave the same
  sign_flip,   ///< over the inputs: holds beyond them
  segments,    ///< bootstrap over segments: on these data
  replicates,  ///< bootstrap over replicates: on these data
};

struct Rules {
  std::string primary;  ///< the number that decides
  double margin =
      0.05;  ///< of equivalence: a ratio of 1 + margin, or so much of the reference's mean
  double alpha = 0.05;
  std::vector<std::string> higher_is_better = {};  ///< globs; of all others lower is
  std::size_t draws = 2000;                        ///< of the bootstrap
  std::uint64_t seed = 1;
};

/// One number of a variant against the reference's. On the scale of the number: for ratios all of
/// estimate, interval and least_shown are natural logarithms.
struct Contrast {
  std::string variant;
  std::vector<std::size_t> inputs;  ///< those where both gave it, ascending
  std::vector<double> by_input;     ///< mean over the replicates, of each of `inputs`
  double estimate = 0;              ///< mean of `by_input`
  std::optional<Interval> interval;
  Method method = Method::none;
  std::optional<double> p, adjusted_p;  ///< of the sign-flip test; adjusted for the variants (Holm)
  double least_p = 1;                   ///< that so many inputs could have given, adjusted
  std::optional<double> least_shown;    ///< smallest difference that could have been shown
  std::size_t failed_inputs = 0;        ///< where the reference gave it and the variant did not
  Verdict verdict = Verdict::not_shown;

  /// Too few inputs to say more than of these data.
  bool on_these_data() const { return method != Method::sign_flip; }
};

/// One number over all runs.
struct Judged {
  std::string name, unit;
  Scale scale = Scale::ratio;
  bool primary = false, higher_is_better = false;  ///< all but the primary are exploratory
  std::vector<Contrast> contrasts = {};  ///< by variant; those that never give it left out
};

/// Every number: each variant against the first one. Numbers that the first variant or all others
/// never give are left out.
std::vector<Judged> judge(const Measured& measured, const Rules& rules);

/// Every number but times: each variant against what `then` has of the one of its name, on the
/// inputs of the same name, files and bytes.
std::vector<Judged> judge_against(const Measured& then, const Measured& now, const Rules& rules);

/// The value that stands for a variant on an input: the mean over its replicates, on the number's
/// scale.
struct Standing {
  std::optional<double> value;  ///< none where it gave none
  bool from_cache = false;      ///< for a part of it, so that it is not compared
};
Standing standing(const Measured& measured, std::size_t variant, std::size_t input,
                  const Judged& number);
/// The mean of values on a scale: geometric for ratios. None for none.
std::optional<double> mean_of(const std::vector<double>& values, Scale scale);

}  // namespace plumb::experiment
