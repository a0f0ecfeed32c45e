#include "plumb/plugin/description.hpp"

#include <cctype>
#include <cmath>

namespace plumb {
namespace {

template <class List>
auto find_named(const List& list, std::string_view name) -> decltype(list.data()) {
  for (const auto& entry : list)
    if (entry.name == name) return &entry;
  return nullptr;
}

std::string bound_text(const ParameterDescription& parameter, double bound) {
  if (parameter.kind == ParameterKind::integer) return std::to_string(std::llround(bound));
  return written(bound, parameter.quantity);
}

}  // namespace

const char* name_of(ParameterKind kind) {
  switch (kind) {
    case ParameterKind::number:
      return "number";
    case ParameterKind::integer:
      return "integer";
    case ParameterKind::boolean:
      return "boolean";
    case ParameterKind::text:
      return "text";
    case ParameterKind::path:
      return "path";
    case ParameterKind::choice:
      return "choice";
  }
  return "?";
}

std::string StepDescription::base() const {
  if (!items) return "WholeStep";
  std::string text = items->name + "Step";
  text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  return text;
}

const InputDescription* StepDescription::input(std::string_view n) const {
  return find_named(inputs, n);
}
const OutputDescription* StepDescription::output(std::string_view n) const {
  return find_named(outputs, n);
}
const ParameterDescription* StepDescription::parameter(std::string_view n) const {
  return find_named(parameters, n);
}

std::string written(const ParameterDescription& parameter, const ParameterValue& value) {
  if (std::holds_alternative<std::monostate>(value)) return "none";
  if (const auto* b = std::get_if<bool>(&value)) return *b ? "true" : "false";
  if (const auto* n = std::get_if<std::int64_t>(&value)) return std::to_string(*n);
  if (const auto* x = std::get_if<double>(&value)) return written(*x, parameter.quantity);
  return std::get<std::string>(value);
}

std::string range_text(const ParameterDescription& parameter) {
  std::string text;
  switch (parameter.kind) {
    case ParameterKind::number:
      text = name_of(parameter.quantity);
      break;
    case ParameterKind::choice:
      for (const Choice& choice : parameter.choices)
        text += (text.empty() ? "one of " : ", ") + choice.name;
      break;
    default:
      text = name_of(parameter.kind);
  }
  if (parameter.kind == ParameterKind::number || parameter.kind == ParameterKind::integer) {
    const bool low = std::isfinite(parameter.low), high = std::isfinite(parameter.high);
    if (low && high)
      text += ", " + bound_text(parameter, parameter.low) + " to " +
              bound_text(parameter, parameter.high);
    else if (low)
      text += ", at least " + bound_text(parameter, parameter.low);
    else if (high)
      text += ", at most " + bound_text(parameter, parameter.high);
  }
  if (parameter.may_be_none) text += ", or none";
  return text;
}

std::string fault_of(const ParameterDescription& parameter, const ParameterValue& value) {
  const std::string expected = "expected " + range_text(parameter);
  if (std::holds_alternative<std::monostate>(value)) return parameter.may_be_none ? "" : expected;
  const auto in_range = [&](double x) {
    return x >= parameter.low && x <= parameter.high ? "" : expected;
  };
  switch (parameter.kind) {
    case ParameterKind::number:
      return std::holds_alternative<double>(value) ? in_range(std::get<double>(value)) : expected;
    case ParameterKind::integer:
      return std::holds_alternative<std::int64_t>(value)
                 ? in_range(static_cast<double>(std::get<std::int64_t>(value)))
                 : expected;
    case ParameterKind::boolean:
      return std::holds_alternative<bool>(value) ? "" : expected;
    case ParameterKind::text:
    case ParameterKind::path:
      return std::holds_alternative<std::string>(value) ? "" : expected;
    case ParameterKind::choice:
      return std::holds_alternative<std::string>(value) &&
                     find_named(parameter.choices, std::get<std::string>(value))
                 ? ""
                 : expected;
  }
  return expected;
}

}  // namespace plumb
