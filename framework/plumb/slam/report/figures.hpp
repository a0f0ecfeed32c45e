#pragma once
/// What of a run is compared.

#include <string>
#include <vector>

#include "plumb/engine/run/runner.hpp"
#include "plumb/slam/experiment/measured.hpp"

namespace plumb {

struct ComparedFigures {
  /// Globs (fnmatch) over "STEP.NUMBER", as in "error.*.ate". None: all numbers of steps called
  /// error, map_error, relation_error and match_rmse; where these measure several stages, of the
  /// last one.
  std::vector<std::string> metrics;
  /// Steps whose names begin so are what is timed and whose iterations count.
  std::vector<std::string> timed = {"register.", "track."};
  /// One number that is compared besides.
  std::string primary = {};
};

/// The numbers of one run that are compared, named "STEP.NUMBER": those chosen, the match RMSE with
/// its sums by segment; then CPU time and iterations (where counted) of the timed steps; last
/// `time`, CPU time of all steps. Numbers that are non-finite are left out. A time is `from_cache`
/// when a step of it took results of an earlier run.
std::vector<experiment::Figure> figures_of(const Plan& plan, const RunResult& result,
                                           const ComparedFigures& chosen);

/// A sentence about the first glob that no number of the run matches, with a number that there is;
/// empty when each matches some.
std::string unmatched(const std::vector<std::string>& globs, const RunResult& result);

/// The same before any run, as far as it is known then: a sentence about the first glob that no
/// number of any step of `plan` can match, as none is called as it begins.
std::string unmatchable(const std::vector<std::string>& globs, const Plan& plan);

}  // namespace plumb
