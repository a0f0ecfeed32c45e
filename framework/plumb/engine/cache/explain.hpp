#pragma once
/// Why a step's results were made or reused: compared with the last run of the same pipeline on the
/// same store.

#include <string>
#include <vector>

#include "plumb/store/index.hpp"

namespace plumb {

/// What decided over the results of a step: its name and version, parameters, files and inputs,
/// each as text. For `--explain`.
using Facts = std::vector<Fact>;

/// What one step did in one pass.
struct Explained {
  std::string path;
  int pass = -1;        ///< from 0; -1 outside of repeats
  bool passes = false;  ///< its values pass through: never kept, made when asked for
  std::size_t made = 0, reused = 0;
  std::string
      why;  ///< the first thing that differs, with old and new value; empty when nothing does

  /// "coarse.near, pass 2: made, all 312: max was 1 m, is 0.8 m"
  std::string text() const;
};

/// The first thing in which `now` differs from `before`, as a sentence; empty when nothing does.
std::string first_difference(const Facts& before, const Facts& now);

}  // namespace plumb
