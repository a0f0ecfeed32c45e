#pragma once
/// What is weak in a run's results: one verdict where most of it is, and no more sentences than
/// anybody reads.

#include <string>
#include <vector>

#include "plumb/engine/run/runner.hpp"

namespace plumb {

/// Sentences that say the same of other segments are one kind: the sentence with every number left
/// out.
std::string kind_of_sentence(const std::string& sentence);

/// What the steps said of their results, as "PATH: sentence". With `warnings` what they warned of
/// while they ran, too. A kind is shown with its first sentences and the number of those that are
/// left out. When most edges between consecutive segments (most edges, where there are none of
/// those) found no pairs or were rejected, over all stages, a verdict with the likely causes comes
/// first and only a few sentences after it.
std::vector<std::string> weaknesses(const RunResult& result, bool warnings);

}  // namespace plumb
