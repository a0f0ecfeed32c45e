#pragma once
/// What the runs of an experiment gave.

#include <string>
#include <vector>

#include "plumb/data/number.hpp"
#include "plumb/slam/experiment/bootstrap.hpp"

namespace plumb::experiment {

/// One number of one run.
struct Figure {
  Number number;
  SegmentSums segments = {};  ///< empty where it is not known by segment
  bool from_cache = false;    ///< a time of which a part was not spent in this run: not compared
};

/// One run: a variant on an input in a replicate.
struct Cell {
  std::vector<Figure> figures = {};
  std::string failure = {};          ///< why it gave none: the step, what is wrong, the cure
  double seconds = 0;                ///< wall clock
  std::size_t made = 0, reused = 0;  ///< results: of this run, and taken from earlier ones

  const Figure* find(const std::string& name) const;
};

/// What was read, as far as it is the same after copying.
struct InputSize {
  std::string name;
  std::size_t files = 0;
  std::uint64_t bytes = 0;
  bool operator==(const InputSize&) const = default;
};

struct Measured {
  std::vector<std::string> variants;
  std::vector<InputSize> inputs;
  std::size_t replicates = 1;
  std::vector<Cell> cells;  ///< by variant, then input, then replicate

  Measured(std::vector<std::string> variant_names = {}, std::vector<InputSize> input_sizes = {},
           std::size_t replicate_count = 1);
  Cell& at(std::size_t variant, std::size_t input, std::size_t replicate = 0);
  const Cell& at(std::size_t variant, std::size_t input, std::size_t replicate = 0) const;
  std::size_t failures() const;
};

/// Names and units of all numbers, in the order of the first run that has them.
std::vector<Number> numbers_in(const Measured& measured);

/// The number that decides where none was named: the first ATE; else the first error against
/// relations or a plan, the match RMSE, the first of all. Empty for none.
std::string usual_primary(const std::vector<Number>& numbers);

}  // namespace plumb::experiment
