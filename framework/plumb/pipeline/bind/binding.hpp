#pragma once
/// The parts of bind().

#include <string>
#include <utility>
#include <vector>

#include "plumb/pipeline/bind/bound.hpp"

namespace plumb::pipeline {

struct BoundParameters {
  std::vector<std::vector<OrFaulty<PlannedParameter>>> of_steps;  ///< none of a faulty step
  std::vector<std::vector<PlannedRow>> rows;                      ///< by repeat
};
/// From `with`, from rows and the pipeline's parameters, or as declared by the steps.
BoundParameters parameters_of(const Declared& declared, Reading& reading);

/// One output that a reference may mean.
struct Source {
  Wire wire;
  const Type* type = nullptr;
  const ItemKind* grain = nullptr;  ///< null: one value of the pipeline
};
/// What a source is, for sentences: "Features, one per segment".
std::string kind_of(const Type& type, const ItemKind* grain);

/// Follows references such as `drift.solved.poses`. What a repeat carries is looked into when the
/// first reference leads there, and is of the type that its first user wants.
class References {
 public:
  References(const Declared& declared, Reading& reading);

  /// The outputs that a reference from `scope` may mean; faulty when it is wrong (told) or leads to
  /// something faulty.
  OrFaulty<std::vector<Source>> sources(int scope, const Node& reference);
  /// Notes that a source is used, and settles the type of what a repeat carries. False when it
  /// cannot be (told).
  bool choose(const Source& source);
  /// What the repeats carry, as far as it was chosen; by repeat.
  std::vector<std::vector<OrFaulty<PlannedCarry>>> carries() const;

 private:
  using Pairs = std::vector<std::pair<Source, Source>>;  ///< start and next, of one type each
  struct Carry {
    bool looked_at = false, known = false;  ///< not known meanwhile: it is carried on as itself
    OrFaulty<Pairs> pairs = Faulty();
    const Type* chosen = nullptr;
    OrFaulty<PlannedCarry> planned = Faulty();
  };
  OrFaulty<std::vector<Source>> carried(const Node& reference, int repeat, int index);
  OrFaulty<Pairs> pairs_of(int repeat, int index);
  OrFaulty<Pairs> matched(const std::string& what, const Node& next,
                          const std::vector<Source>& starts, const std::vector<Source>& nexts);

  const Declared& declared_;
  Reading& reading_;
  std::vector<std::vector<Carry>> carries_;  ///< by repeat
};

/// The wires of each step's input ports; none of a faulty step.
std::vector<std::vector<std::vector<OrFaulty<Wire>>>> inputs_of(const Declared& declared,
                                                                References& references,
                                                                Reading& reading);

/// When a repeat may end before its passes are used up.
struct BoundConditions {
  bool all = true;
  std::vector<OrFaulty<PlannedCondition>> conditions = {};
};
BoundConditions conditions_of(const Declared& declared, int repeat, References& references,
                              Reading& reading);

}  // namespace plumb::pipeline
