#include "plumb/slam/experiment/outcome.hpp"

#include "../fuzz.hpp"

using namespace plumb;

/// What `plumb compare` wrote as JSON; written and read again it is the same.
PLUMB_FUZZ_READER(outcome) {
  const auto read = experiment::outcome_of_json(fuzz::file_of(bytes, "outcome.json"));
  const auto& m = read.measured;
  fuzz::require(m.cells.size() == m.variants.size() * m.inputs.size() * m.replicates,
                "there is a cell for each run");
  constexpr std::size_t quick = 1000;
  if (m.cells.size() > quick) return;
  const auto again = experiment::outcome_of_json(fuzz::file_of(outcome_json(read), "outcome.json"));
  fuzz::require(again.measured.variants.size() == m.variants.size() &&
                    again.measured.failures() == m.failures(),
                "what was read and written is read again");
}
