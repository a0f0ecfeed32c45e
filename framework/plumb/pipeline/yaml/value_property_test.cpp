/// What must hold for any number and any text in a pipeline.
#include <rapidcheck/gtest.h>

#include <cmath>

#include "plumb/pipeline/yaml/diagnostics.hpp"
#include "plumb/pipeline/yaml/value.hpp"

namespace plumb::pipeline {
namespace {

/// Finite, of any size.
double any_number() {
  const double number = *rc::gen::arbitrary<double>();
  RC_PRE(std::isfinite(number));
  return number;
}

RC_GTEST_PROP(Number, AsShortestTextIsReadAsTheSameNumber, ()) {
  const double number = any_number();
  const auto read = read_number(shortest(number));
  RC_ASSERT(std::holds_alternative<Measured>(read));
  RC_ASSERT(std::get<Measured>(read).si == number);
}

RC_GTEST_PROP(Number, WithAUnitIsReadInSi, ()) {
  const Unit& unit = *rc::gen::elementOf(units());
  const double number = *rc::gen::inRange(-1'000'000, 1'000'000) / 64.0;
  const auto read = read_number(shortest(number) + " " + unit.symbol);
  RC_ASSERT(std::holds_alternative<Measured>(read));
  RC_ASSERT(std::get<Measured>(read).si == number * unit.factor);
  RC_ASSERT(std::get<Measured>(read).unit->quantity == unit.quantity);
}

RC_GTEST_PROP(Number, IsReadOrRefusedInASentence, (const std::string& text)) {
  const auto read = read_number(text);
  if (const auto* fault = std::get_if<Fault>(&read)) RC_ASSERT(!fault->sentence.empty());
  if (const auto* number = std::get_if<Measured>(&read)) RC_ASSERT(std::isfinite(number->si));
}

RC_GTEST_PROP(Text, WithItsDollarsDoubledMeansItself, (const std::string& text)) {
  Node node;
  node.kind = Node::Kind::scalar;
  node.text = dollars_doubled(text);
  RC_ASSERT(!reference_in(node));
  RC_ASSERT(text_in(node) == text);
}

RC_GTEST_PROP(NearestName, IsTheNameItselfWhereItIsKnown, ()) {
  const auto letters = rc::gen::container<std::string>(rc::gen::inRange('a', 'z'));
  auto known = *rc::gen::nonEmpty(rc::gen::container<std::vector<std::string>>(letters));
  const std::string name = *rc::gen::elementOf(known);
  RC_PRE(!name.empty() && name.size() <= 64);  // longer ones are not compared
  RC_ASSERT(nearest(name, known) == name);
}

}  // namespace
}  // namespace plumb::pipeline
