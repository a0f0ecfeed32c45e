#pragma once
/// The stage behind the names: every value and every wire is there, or faulty.

#include <vector>

#include "plumb/pipeline/bind/declared.hpp"

namespace plumb::pipeline {

struct BoundStep {
  const StepDescription* description = nullptr;
  std::vector<OrFaulty<PlannedParameter>> parameters;  ///< by the description's parameters
  /// By input port; none for an optional one that is not wired. One that lacks its wire has a
  /// faulty one.
  std::vector<std::vector<OrFaulty<Wire>>> inputs;
};

struct BoundRepeat {
  std::vector<PlannedRow> rows;                 ///< as declared; no values where nothing uses one
  std::vector<OrFaulty<PlannedCarry>> carries;  ///< as declared; faulty where nothing uses one
  bool all = true;                              ///< all conditions must hold, else any
  std::vector<OrFaulty<PlannedCondition>> conditions;
};

struct Bound {
  Declared declared;
  std::vector<OrFaulty<BoundStep>> steps;  ///< as declared; faulty: no module offers it
  std::vector<BoundRepeat> repeats;        ///< as declared
  Uses uses;                               ///< by anything
  NamesOfNow now;
};

/// Follows all references. `names` and `diagnostics` are those that `declared` was made with.
Bound bind(const Declared& declared, Renamer& names, Diagnostics& diagnostics);

}  // namespace plumb::pipeline
