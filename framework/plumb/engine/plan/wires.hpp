#pragma once
/// Walks over the steps and wires of a plan, into repeats too.

#include <functional>
#include <vector>

#include "plumb/pipeline/bind/plan.hpp"

namespace plumb {

/// `step` draws on `wire` through `port`; -1 and null: a repeat does, which starts with it, carries
/// it or judges by it.
using VisitWire = std::function<void(int step, const Wire& wire, const InputDescription* port)>;
void visit_wires(const Plan& plan, const PlannedItem& item, const VisitWire& visit);

/// In the order in which they run, each with the innermost repeat around it; `repeat` stands for
/// those directly in `items`.
using VisitStep = std::function<void(int step, int repeat)>;
void visit_steps(const Plan& plan, const std::vector<PlannedItem>& items, int repeat,
                 const VisitStep& visit);

}  // namespace plumb
