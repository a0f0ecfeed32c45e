#pragma once
/// For tests of a step as the engine sees it: inputs by port name, parameters by name, outputs by
/// port name. A test of a module includes this, and plumb_module() of the module itself is linked
/// in.
///
///   StepUnderTest step(*plumb_module());
///   step.with("matches", matches).part("poses", T_i_j).set("max", 0.5);
///   const auto kept = step.run<Matches>("matches", context);

#include <gtest/gtest.h>

#include "plumb/plugin/module.hpp"
#include "plumb/plugin/testing.hpp"

extern "C" const PlumbModule* plumb_module();

namespace plumb {

class StepUnderTest {
 public:
  explicit StepUnderTest(const PlumbModule& module, std::size_t which = 0)
      : step_(module.steps[which]), inputs_(step_->description().inputs.size()) {
    for (const auto& p : step_->description().parameters)
      if (!p.required) values_[p.name] = p.standard;
  }

  /// The item's, or the pipeline's, value.
  template <class T>
  StepUnderTest& with(std::string_view port, T value) {
    input(port).one = any_value(std::move(value));
    return *this;
  }
  template <class T>
  StepUnderTest& ends(std::string_view port, T i, T j) {
    input(port).one = any_value(std::move(i));
    inputs_[place(port)].other = any_value(std::move(j));
    return *this;
  }
  template <class T>
  StepUnderTest& each(std::string_view port, std::vector<T> values) {
    input(port).each = held(std::move(values), {});
    return *this;
  }
  /// Values that belong to the items of a list.
  template <class T, class List>
  StepUnderTest& each(std::string_view port, std::vector<T> values, List list) {
    input(port).each = held(std::move(values), any_value(std::move(list)));
    return *this;
  }
  /// Adds one to any number of labelled values.
  template <class T>
  StepUnderTest& add(std::string_view port, std::string label, T value) {
    input(port).several.emplace_back(std::move(label), any_value(std::move(value)));
    return *this;
  }
  /// What the item sees of a value of the pipeline: T_i_j, an edge.
  template <class T>
  StepUnderTest& part(std::string_view port, T value) {
    input(port).part = seen_part(std::move(value));
    return *this;
  }
  StepUnderTest& over(std::string_view port) {
    input(port);
    return *this;
  }
  StepUnderTest& set(const std::string& parameter, ParameterValue value) {
    const auto* description = step_->description().parameter(parameter);
    EXPECT_NE(description, nullptr) << "no parameter " << parameter;
    if (description) {
      EXPECT_EQ(fault_of(*description, value), "") << parameter;
    }
    values_[parameter] = std::move(value);
    return *this;
  }

  /// Runs the step; one value of the output `port`.
  template <class T>
  T run(std::string_view port, Context& context) const {
    const auto parameters = step_->parameters(values_);
    std::vector<PortOutput> outputs(step_->description().outputs.size());
    step_->run(parameters.get(), inputs_, outputs, context);
    for (std::size_t k = 0; k < outputs.size(); ++k)
      if (step_->description().outputs[k].name == port) return *outputs[k].one.template as<T>();
    throw std::logic_error("no output " + std::string(port));
  }

 private:
  std::size_t place(std::string_view port) const {
    const auto& inputs = step_->description().inputs;
    for (std::size_t k = 0; k < inputs.size(); ++k)
      if (inputs[k].name == port) return k;
    throw std::logic_error("no input " + std::string(port));
  }
  PortInput& input(std::string_view port) {
    PortInput& in = inputs_[place(port)];
    in.wired = true;
    return in;
  }

  const Step* step_;
  std::vector<PortInput> inputs_;
  ParameterValues values_;
};

}  // namespace plumb
