#pragma once
/// What a declaration says of one parameter.

#include <limits>
#include <set>
#include <stdexcept>
#include <utility>

#include "plumb/plugin/description.hpp"

namespace plumb {

/// Fluent description of one parameter; returned by param() and choice() of a declaration.
class ParameterBuilder {
 public:
  explicit ParameterBuilder(ParameterDescription& description) : of_(&description) {}
  /// Unit of the C++ field: "m", "rad", "s", "m/s", "rad/s", "rad/m", "Hz", or "%" for a ratio (the
  /// field holds 0.02 for 2 %).
  ParameterBuilder& unit(const char* symbol) {
    const Unit* unit = find_unit(symbol);
    if (!unit) throw std::logic_error("parameter '" + of_->name + "': no such unit");
    of_->quantity = unit->quantity;
    return *this;
  }
  /// Inclusive bounds, SI.
  ParameterBuilder& range(double low, double high = std::numeric_limits<double>::infinity()) {
    of_->low = low;
    of_->high = high;
    return *this;
  }
  ParameterBuilder& doc(const char* text) {
    of_->doc = text;
    return *this;
  }
  ParameterBuilder& source(const char* text) {
    of_->source = text;
    return *this;
  }
  ParameterBuilder& required() {
    of_->required = true;
    return *this;
  }
  /// Does not change the result, only how it is reached: not part of an item's key.
  ParameterBuilder& without_effect() {
    of_->affects_result = false;
    return *this;
  }
  /// Another name in YAML than the one that the options have for it.
  ParameterBuilder& named(const char* text) {
    of_->name = text;
    return *this;
  }
  /// The same values of a choice in another order, with what they mean in this step.
  ParameterBuilder& choices(std::vector<Choice> list) {
    if (names_of(list) != names_of(of_->choices))
      throw std::logic_error("parameter '" + of_->name + "': these are not its values");
    of_->choices = std::move(list);
    return *this;
  }

 private:
  static std::set<std::string> names_of(const std::vector<Choice>& list) {
    std::set<std::string> names;
    for (const Choice& choice : list) names.insert(choice.name);
    return names;
  }

  ParameterDescription* of_;
};

}  // namespace plumb
