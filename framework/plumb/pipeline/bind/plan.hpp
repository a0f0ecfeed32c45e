#pragma once
/// A checked pipeline: every name resolved, every value in SI and in range, every wire typed. What
/// the engine runs.

#include <optional>
#include <string>
#include <vector>

#include "plumb/pipeline/yaml/origin.hpp"
#include "plumb/pipeline/yaml/renaming.hpp"
#include "plumb/plugin/description.hpp"

namespace plumb {

/// Where an input comes from: an output of a step, or what a repeat carries.
struct Wire {
  int step = -1, output = -1;   ///< index into Plan::steps and its outputs, or
  int repeat = -1, carry = -1;  ///< index into Plan::repeats and its carries (inside its body)
  std::string label;  ///< for `several`: the key in a mapping, else the reference as written
  Origin origin;
};

/// A parameter's value and where it came from; or the row of a repeat that drives it.
struct PlannedParameter {
  ParameterValue value;       ///< as in the first pass, when a row drives it
  Origin origin;              ///< empty file for a declared default
  int repeat = -1, row = -1;  ///< index into Plan::repeats and its rows
};

/// What follows when a call of a step fails.
enum class OnError {
  stop,  ///< the run stops when the step's other items are done
  drop,  ///< the item's values are empty: an edge without matches
};

struct PlannedStep {
  std::string path;  ///< "coarse.matches"
  const StepDescription* description = nullptr;
  Origin origin;
  std::vector<std::vector<Wire>>
      inputs;  ///< by input port; none for an optional port that is not wired
  std::vector<PlannedParameter> parameters;  ///< by the description's parameters, defaults included
  OnError on_error = OnError::stop;
  int domain = -1;  ///< of frame-, segment- and edge-wise steps: the step whose output says which
                    ///< items there are
};

/// Steps and repeats in an order in which they can run.
struct PlannedItem {
  int step = -1, repeat = -1;
};

struct PlannedRow {
  std::string name;
  std::vector<ParameterValue> values;  ///< one a pass, or one for all; none when nothing uses it
  ParameterKind kind = ParameterKind::number;
  Quantity quantity = Quantity::none;
  Origin origin;
};
struct PlannedCarry {
  std::string name;
  Wire start;  ///< before the first pass
  Wire next;   ///< a body step's output, carried into the next pass
};
/// metric `name` of Metrics output of `step` falls by less than `share` of its value from one pass
/// to the next; or is below `bound`.
struct PlannedCondition {
  int step = -1, output = -1;
  std::string metric;                        ///< name of the number; empty for the first
  std::optional<double> falls_by_less_than;  ///< ratio
  std::optional<double> below;               ///< in the number's own unit
  Origin origin;
  std::string metric_text;  ///< "rmse", as written
  std::string text;         ///< as written, for the record of why a loop ended
};
enum class Exhausted { warn, fail, accept };

struct PlannedRepeat {
  std::string path;
  Origin origin;
  std::vector<PlannedRow> rows;
  std::vector<PlannedCarry> carries;
  std::vector<PlannedCondition> conditions;
  bool all = true;                ///< all conditions must hold, else any
  int passes = 1;                 ///< columns of the rows
  int at_least = 2, at_most = 1;  ///< passes; without `until` at_most is the columns
  Exhausted if_exhausted = Exhausted::warn;
  std::vector<PlannedItem> body;

  /// The value of a row in a pass (from 0): when the columns are used up, the last one repeats.
  const ParameterValue& value(int row, int pass) const {
    const auto& v = rows[row].values;
    return v[std::min<std::size_t>(pass, v.size() - 1)];
  }
  /// "3 to 5 passes"; "1 pass".
  std::string passes_text() const {
    const bool open = !conditions.empty() && at_least < at_most;
    return (open ? std::to_string(at_least) + " to " : "") + std::to_string(at_most) +
           (at_most == 1 ? " pass" : " passes");
  }
};

struct PlannedSetting {
  std::string name, about;
  std::string value;  ///< as written
  Origin origin;
};

struct Plan {
  std::string name, about;
  std::vector<std::string> files;        ///< read, the pipeline first
  std::vector<PlannedSetting> settings;  ///< the pipeline's parameters
  std::vector<PlannedStep> steps;
  std::vector<PlannedRepeat> repeats;
  std::vector<PlannedItem> order;
  std::string
      resolved;  ///< the pipeline after overlays as YAML, each value with a comment on its origin
  std::vector<Renaming> renamings;  ///< what is written as an earlier release had it
  /// What is no mistake and perhaps not meant, a line each: "--set voxel=2m: warning: nothing uses
  /// the parameter 'voxel' any more, ...".
  std::vector<std::string> warnings;
};

}  // namespace plumb
