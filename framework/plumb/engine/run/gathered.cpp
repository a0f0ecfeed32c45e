#include "plumb/engine/run/gathered.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "plumb/engine/plan/wires.hpp"
#include "plumb/engine/run/step_run.hpp"

namespace plumb {

Gathered::Gathered(const Plan& plan)
    : plan_(plan), documents_(plan.steps.size()), numbers_(plan.steps.size()) {}

void Gathered::add(int step, StepRun& run) {
  if (run.itemwise()) return;
  documents_[step].clear();
  numbers_[step].clear();
  const auto& outputs = plan_.steps[step].description->outputs;
  for (std::size_t o = 0; o < outputs.size(); ++o) {
    const int output = static_cast<int>(o);
    if (outputs[o].type == &type_of<Document>())
      for (std::size_t k = 0; k < run.count(output); ++k)
        documents_[step].push_back(run.value(output, k).as<Document>());
    if (outputs[o].type->has_numbers && outputs[o].emission == Emission::one)
      numbers_[step].push_back(run.value(output));
  }
}

void Gathered::add(const Turn& turn, LoopEnd loop) {
  const std::lock_guard lock(mutex_);
  loops_.emplace(turn, std::move(loop));
}

void Gathered::add(const Turn& turn, Explained explained) {
  const std::lock_guard lock(mutex_);
  explained_.emplace(turn, std::move(explained));
}

RunResult Gathered::result(Bookkeeping& books) {
  RunResult result;
  for (std::size_t s = 0; s < plan_.steps.size(); ++s) {
    for (auto& document : documents_[s])
      result.documents.push_back({plan_.steps[s].path, document});
    for (auto& numbers : numbers_[s]) result.numbers.push_back({plan_.steps[s].path, numbers});
  }
  for (auto& [turn, loop] : loops_) result.loops.push_back(std::move(loop));
  for (auto& [turn, explained] : explained_) result.explained.push_back(std::move(explained));
  result.warnings = books.warnings();
  result.counts = books.counts();
  result.times = in_order(books.times());
  result.peak_bytes = books.memory().peak();
  return result;
}

std::vector<StepTime> Gathered::in_order(std::vector<StepTime> times) const {
  std::map<std::string, std::size_t> place;
  visit_steps(plan_, plan_.order, -1,
              [&](int step, int) { place.emplace(plan_.steps[step].path, place.size()); });
  std::sort(times.begin(), times.end(),
            [&](const StepTime& a, const StepTime& b) { return place[a.path] < place[b.path]; });
  return times;
}

}  // namespace plumb
