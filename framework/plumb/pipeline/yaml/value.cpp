#include "plumb/pipeline/yaml/value.hpp"

#include <charconv>
#include <cmath>
#include <cstdio>

namespace plumb::pipeline {
namespace {

std::string with_article(const std::string& noun) {
  const bool vowel = noun.find_first_of("aeiou") == 0;
  return (vowel ? "an " : "a ") + noun;
}

/// " (of parameter's kind) ...": all units of all quantities, for the nearest one.
std::vector<std::string> symbols() {
  std::vector<std::string> all;
  for (const Unit& unit : units()) all.emplace_back(unit.symbol);
  return all;
}

/// `number` has none. Of a ratio what is below 1 was meant as a share, not as so many percent.
std::string unit_cure(Quantity quantity, const std::string& number, double value) {
  const std::string known = known_units(quantity);
  if (quantity == Quantity::ratio && std::abs(value) < 1)
    return "Write the unit: the share " + number + " is '" + written(value, quantity) + "'.";
  return "Write the unit, as in '" + number + " " + known.substr(0, known.find(',')) +
         "'; known: " + known + ".";
}

/// `number` has one and should not. A share is written as such, not as its percents.
std::string bare_cure(const Measured& number) {
  if (number.unit->quantity != Quantity::ratio)
    return "Leave out the '" + std::string(number.unit->symbol) + "'.";
  char share[32];  // 12 digits hide what the factor adds: 0.01 * 57
  std::snprintf(share, sizeof share, "%.12g", number.si);
  return std::string("Write ") + share + ".";
}

/// What a number that does not serve should be: who wrote one does not ask for none.
std::string expected_instead(ParameterDescription parameter) {
  parameter.may_be_none = false;
  return expected(parameter);
}

std::variant<ParameterValue, Fault> read_quantity(const ParameterDescription& parameter,
                                                  const std::string& text) {
  auto number = read_number(text);
  if (auto* fault = std::get_if<Fault>(&number)) return *fault;
  const Measured measured = std::get<Measured>(number);
  if (parameter.quantity == Quantity::none) {
    if (measured.unit)
      return Fault{"'" + text + "' has a unit, expected a bare number", bare_cure(measured)};
  } else if (!measured.unit) {
    return Fault{"'" + text + "' has no unit, expected " + expected_instead(parameter),
                 unit_cure(parameter.quantity, text, measured.si)};
  } else if (measured.unit->quantity != parameter.quantity) {
    return Fault{"'" + text + "' is " + with_article(name_of(measured.unit->quantity)) +
                     ", expected " + expected_instead(parameter),
                 "Known units: " + known_units(parameter.quantity) + "."};
  }
  return ParameterValue(measured.si);
}

std::variant<ParameterValue, Fault> read_integer(const std::string& text) {
  std::int64_t value = 0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  const std::size_t digits = text.find_first_not_of('-');
  const bool leading_zero =
      digits != std::string::npos && text[digits] == '0' && text.size() > digits + 1;
  if (error != std::errc() || stop != end || leading_zero)
    return Fault{"'" + text + "' is not an integer", "Write digits alone, as in '20'."};
  return ParameterValue(value);
}

std::variant<ParameterValue, Fault> read_scalar(const ParameterDescription& parameter,
                                                const Node& node) {
  const bool worded = parameter.kind == ParameterKind::text ||
                      parameter.kind == ParameterKind::path ||
                      parameter.kind == ParameterKind::choice;
  if (node.quoted && !worded)
    return Fault{node.shown() + " is text, expected " + expected(parameter),
                 "Leave out the quotes."};
  const auto words = worded ? text_in(node) : node.text;
  if (!words)
    return Fault{"'" + node.text + "' has a '$' in it; a reference stands alone, as in '$name'",
                 how_to_write_a_dollar};
  switch (parameter.kind) {
    case ParameterKind::number:
      return read_quantity(parameter, node.text);
    case ParameterKind::integer:
      return read_integer(node.text);
    case ParameterKind::boolean:
      if (node.text == "true" || node.text == "false") return ParameterValue(node.text == "true");
      return Fault{"'" + node.text + "' is not a boolean", "Write true or false."};
    case ParameterKind::text:
      return ParameterValue(*words);
    case ParameterKind::path: {
      if (words->empty()) return Fault{"the path is empty", ""};
      const std::filesystem::path base = node.origin.line > 0
                                             ? std::filesystem::path(node.origin.file).parent_path()
                                             : std::filesystem::path();
      return ParameterValue(std::filesystem::absolute(base / *words).lexically_normal().string());
    }
    case ParameterKind::choice: {
      std::vector<std::string> known;
      for (const Choice& choice : parameter.choices) known.push_back(choice.name);
      for (const std::string& name : known)
        if (name == *words) return ParameterValue(name);
      return Fault{"'" + *words + "' is not one of the choices", did_you_mean(*words, known)};
    }
  }
  return Fault{"?", ""};
}

bool has_choice(const ParameterDescription& parameter, std::string_view name) {
  for (const Choice& choice : parameter.choices)
    if (choice.name == name) return true;
  return false;
}

}  // namespace

std::variant<Measured, Fault> read_number(const std::string& text) {
  double value = 0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error == std::errc::result_out_of_range)
    return Fault{"'" + text + "' is out of the range of numbers", ""};
  if (error != std::errc() || !std::isfinite(value))
    return Fault{"'" + text + "' is not a number", ""};
  std::string behind(stop, end);
  behind.erase(0, behind.find_first_not_of(' ') == std::string::npos
                      ? behind.size()
                      : behind.find_first_not_of(' '));
  if (behind.empty()) return Measured{value, nullptr};
  const Unit* unit = find_unit(behind);
  if (!unit)
    return Fault{"'" + behind + "' behind the number is not a unit",
                 did_you_mean(behind, symbols())};
  const double si = value * unit->factor;
  if (!std::isfinite(si)) return Fault{"'" + text + "' is out of the range of numbers", ""};
  return Measured{si, unit};
}

std::optional<std::string> reference_in(const Node& node) {
  if (!node.is_scalar() || node.quoted || node.text.size() < 2 || node.text[0] != '$')
    return std::nullopt;
  for (const char c : node.text.substr(1))
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '_') return std::nullopt;
  return node.text.substr(1);
}

std::optional<std::string> text_in(const Node& node) {
  if (node.quoted) return node.text;
  std::string text;
  for (std::size_t k = 0; k < node.text.size(); ++k) {
    text += node.text[k];
    if (node.text[k] != '$') continue;
    if (++k == node.text.size() || node.text[k] != '$') return std::nullopt;
  }
  return text;
}

std::string dollars_doubled(const std::string& text) {
  std::string all;
  for (const char c : text) all += c == '$' ? std::string("$$") : std::string(1, c);
  return all;
}

std::string expected(const ParameterDescription& parameter) {
  const std::string text = range_text(parameter);
  return parameter.kind == ParameterKind::choice ? text : with_article(text);
}

std::variant<ParameterValue, Fault> read_value(const ParameterDescription& parameter,
                                               const Node& node) {
  if (!node.is_scalar())
    return Fault{"expected " + expected(parameter) + ", found " + node.shown(),
                 node.kind == Node::Kind::none && parameter.may_be_none ? "Write none." : ""};
  if (node.text == "none" && !node.quoted && parameter.may_be_none &&
      !has_choice(parameter, "none"))
    return ParameterValue();
  auto value = read_scalar(parameter, node);
  if (std::holds_alternative<Fault>(value)) return value;
  const std::string fault = fault_of(parameter, std::get<ParameterValue>(value));
  if (!fault.empty()) return Fault{node.shown() + " is out of range, " + fault, ""};
  return value;
}

std::variant<ParameterValue, Fault> converted(const ParameterDescription& from,
                                              const ParameterValue& value,
                                              const ParameterDescription& to) {
  ParameterDescription strict = from;  // for the sentence: any parameter of a pipeline may be none
  strict.may_be_none = false;
  ParameterValue result = value;
  if (!std::holds_alternative<std::monostate>(value)) {
    const bool integer_as_number = from.kind == ParameterKind::integer &&
                                   to.kind == ParameterKind::number &&
                                   to.quantity == Quantity::none;
    const bool words = (from.kind == ParameterKind::text && to.kind == ParameterKind::choice) ||
                       (from.kind == ParameterKind::choice && to.kind == ParameterKind::text);
    if (integer_as_number)
      result = static_cast<double>(std::get<std::int64_t>(value));
    else if (!words && (from.kind != to.kind || from.quantity != to.quantity))
      return Fault{"it is " + expected(strict) + ", expected " + expected(to), ""};
  }
  const std::string fault = fault_of(to, result);
  if (!fault.empty())
    return Fault{"its value " + written(from, value) + " does not fit, " + fault, ""};
  return result;
}

}  // namespace plumb::pipeline
