/// From names to values and wires: the parts of bind() in their order.
#include "plumb/pipeline/bind/binding.hpp"

namespace plumb::pipeline {

Bound bind(const Declared& declared, Renamer& names, Diagnostics& diagnostics) {
  Reading reading{names, diagnostics, declared.uses, declared.now};
  References references(declared, reading);
  BoundParameters parameters = parameters_of(declared, reading);
  auto inputs = inputs_of(declared, references, reading);

  Bound bound;
  bound.declared = declared;
  for (std::size_t k = 0; k < declared.steps.size(); ++k) {
    const auto& use = declared.steps[k].use;
    if (use)
      bound.steps.push_back(
          BoundStep{use->description, std::move(parameters.of_steps[k]), std::move(inputs[k])});
    else
      bound.steps.push_back(Faulty());
  }
  for (std::size_t k = 0; k < declared.repeats.size(); ++k) {
    BoundConditions until = conditions_of(declared, static_cast<int>(k), references, reading);
    bound.repeats.push_back(
        {std::move(parameters.rows[k]), {}, until.all, std::move(until.conditions)});
  }
  auto carries = references.carries();  // also a condition may lead to one
  for (std::size_t k = 0; k < declared.repeats.size(); ++k)
    bound.repeats[k].carries = std::move(carries[k]);
  bound.uses = std::move(reading.uses);
  bound.now = std::move(reading.now);
  return bound;
}

}  // namespace plumb::pipeline
