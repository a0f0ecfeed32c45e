#pragma once
/// When a repeat ends.

#include <optional>
#include <string>
#include <vector>

#include "plumb/pipeline/bind/plan.hpp"

namespace plumb {

/// The values of a repeat's conditions after each pass, and what follows from them.
class LoopJudge {
 public:
  explicit LoopJudge(const PlannedRepeat& repeat) : repeat_(repeat) {}

  /// Takes the conditions' values after one more pass; returns why the loop ends here, or nothing
  /// when it goes on.
  std::optional<std::string> after_pass(std::vector<double> values);
  int passes() const { return static_cast<int>(values_.size()); }

 private:
  bool holds(std::size_t condition) const;
  /// What ended the loop: "rmse falls by less than 2 % (0.2101 -> 0.2096)", or that it rose.
  std::string why(std::size_t condition) const;
  const PlannedRepeat& repeat_;
  std::vector<std::vector<double>> values_;  ///< by pass, then condition
};

}  // namespace plumb
