#pragma once
/// For tests of verdicts: outcomes of runs that nobody made.

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "plumb/data/random.hpp"
#include "plumb/slam/experiment/measured.hpp"

namespace plumb::experiment::test {

/// Value of a variant on an input in a replicate; none: the run failed.
using ValueOf = std::function<std::optional<double>(std::size_t variant, std::size_t input,
                                                    std::size_t replicate)>;

inline Measured measured(const std::vector<std::string>& variants, std::size_t inputs,
                         const ValueOf& value_of, std::size_t replicates = 1,
                         const std::string& name = "error.fine.ate",
                         const std::string& unit = "m") {
  std::vector<InputSize> sizes;
  for (std::size_t k = 0; k < inputs; ++k)
    sizes.push_back({"input_" + std::to_string(k), 10, 1000});
  Measured made(variants, sizes, replicates);
  for (std::size_t v = 0; v < variants.size(); ++v)
    for (std::size_t k = 0; k < inputs; ++k)
      for (std::size_t r = 0; r < replicates; ++r) {
        Cell& cell = made.at(v, k, r);
        if (const auto value = value_of(v, k, r))
          cell.figures.push_back({{name, *value, unit}});
        else
          cell.failure = "step 'matched': needs normals; put estimate.normals before it";
      }
  return made;
}

/// Nearly normal, of deviation 1.
inline double normal(Random& random) {
  double sum = -6;
  for (int k = 0; k < 12; ++k) sum += random.uniform();
  return sum;
}

}  // namespace plumb::experiment::test
