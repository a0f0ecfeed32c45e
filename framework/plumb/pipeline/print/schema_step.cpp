#include "plumb/pipeline/print/schema_step.hpp"

#include <cmath>

namespace plumb::pipeline {
namespace {

std::string escaped(const std::string& text) {
  std::string all;
  for (const char c : text) {
    if (std::string_view(".*+?()[]{}|^$\\/").find(c) != std::string_view::npos) all += '\\';
    all += c;
  }
  return all;
}

/// "0.3 m", "2m": the reader's rule for numbers with a unit.
std::string quantity_pattern(const ParameterDescription& parameter) {
  std::string symbols;
  for (const Unit& unit : units())
    if (unit.quantity == parameter.quantity)
      symbols += (symbols.empty() ? "" : "|") + escaped(unit.symbol);
  const std::string sign = parameter.low >= 0 ? "" : "-?";
  return sign + "([0-9]+\\.?[0-9]*|\\.[0-9]+)([eE][-+]?[0-9]+)? *(" + symbols + ")";
}

Json bound(const ParameterDescription& parameter, double value) {
  if (parameter.kind == ParameterKind::integer && std::abs(value) < 9e15)
    return std::llround(value);
  return value;
}

Json default_of(const ParameterDescription& parameter) {
  const ParameterValue& value = parameter.standard;
  if (const auto* b = std::get_if<bool>(&value)) return *b;
  if (const auto* n = std::get_if<std::int64_t>(&value)) return *n;
  if (const auto* x = std::get_if<double>(&value); x && parameter.quantity == Quantity::none)
    return *x;
  return written(parameter, value);
}

std::string sentence(const std::string& text) {
  if (text.empty()) return "";
  std::string all = text;
  all[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(all[0])));
  return all + (all.back() == '.' ? "" : ".");
}

void describe(Json& schema, const ParameterDescription& parameter) {
  std::string text = sentence(parameter.doc);
  std::string markdown = text + (text.empty() ? "" : "\n\n") + "*" + range_text(parameter) + "*";
  if (parameter.required)
    markdown += ", required";
  else
    markdown += ", default `" + written(parameter, parameter.standard) + "`";
  for (const Choice& choice : parameter.choices)
    if (!choice.doc.empty()) markdown += "\n- `" + choice.name + "`: " + choice.doc;
  if (!parameter.source.empty()) markdown += "\n\nSource: " + parameter.source;
  schema["description"] =
      text.empty() ? range_text(parameter) : text + " " + sentence(range_text(parameter));
  schema["markdownDescription"] = markdown;
  if (!parameter.required) schema["default"] = default_of(parameter);
}

const char* reference_text = "^[A-Za-z][A-Za-z0-9_]*(\\.[A-Za-z][A-Za-z0-9_]*)*$";

Json schema_of_input(const InputDescription& input) {
  Json schema;
  const bool several = input.access == Access::several;
  schema["type"] = several ? Json({"string", "array", "object"}) : Json("string");
  schema["pattern"] = reference_text;
  if (several) {
    const Json one = {{"type", "string"}, {"pattern", reference_text}};
    schema["items"] = one;
    schema["minItems"] = 1;
    schema["additionalProperties"] = one;
  }
  schema["description"] = sentence(input.doc) + (input.doc.empty() ? "" : " ") + input.type->name +
                          (input.optional ? ", optional." : ".");
  return schema;
}

/// `from`: the one port that fits, a list for the one that takes several, or ports by name.
Json schema_of_from(const StepDescription& step) {
  if (step.inputs.empty()) return false;
  Json ports = Json::object();
  bool several = false;
  for (const InputDescription& input : step.inputs) {
    ports[input.name] = schema_of_input(input);
    several = several || input.access == Access::several;
  }
  Json schema;
  schema["type"] = several ? Json({"string", "array", "object"}) : Json({"string", "object"});
  schema["pattern"] = reference_text;
  if (several) schema["items"] = {{"type", "string"}, {"pattern", reference_text}};
  schema["properties"] = ports;
  schema["additionalProperties"] = false;
  return schema;
}

}  // namespace

Json schema_of_value(const ParameterDescription& parameter) {
  const std::string none = parameter.may_be_none ? "|none" : "";
  const std::string words = "^(" + std::string(reference_pattern) + none + ")$";
  Json schema;
  switch (parameter.kind) {
    case ParameterKind::number:
    case ParameterKind::integer:
      if (parameter.quantity != Quantity::none) {
        schema["type"] = "string";
        schema["pattern"] =
            "^(" + quantity_pattern(parameter) + "|" + reference_pattern + none + ")$";
        break;
      }
      schema["type"] = {parameter.kind == ParameterKind::integer ? "integer" : "number", "string"};
      if (std::isfinite(parameter.low)) schema["minimum"] = bound(parameter, parameter.low);
      if (std::isfinite(parameter.high)) schema["maximum"] = bound(parameter, parameter.high);
      schema["pattern"] = words;
      break;
    case ParameterKind::boolean:
      schema["type"] = {"boolean", "string"};
      schema["pattern"] = words;
      break;
    case ParameterKind::text:
      schema["type"] = {"string", "number", "boolean"};
      break;
    case ParameterKind::path:
      schema["type"] = "string";
      break;
    case ParameterKind::choice: {
      Json names = Json::array();
      bool none_is_a_choice = false;
      for (const Choice& choice : parameter.choices) {
        names.push_back(choice.name);
        none_is_a_choice = none_is_a_choice || choice.name == "none";
      }
      if (parameter.may_be_none && !none_is_a_choice) names.push_back("none");
      schema["anyOf"] = {
          {{"enum", names}},
          {{"type", "string"}, {"pattern", "^" + std::string(reference_pattern) + "$"}}};
      break;
    }
  }
  return schema;
}

Json schema_of_step(const StepDescription& step) {
  Json values = Json::object(), required = Json::array();
  for (const ParameterDescription& parameter : step.parameters) {
    values[parameter.name] = schema_of_value(parameter);
    describe(values[parameter.name], parameter);
    if (parameter.required) required.push_back(parameter.name);
  }
  Json with;
  with["type"] = "object";
  with["properties"] = values;
  with["additionalProperties"] = false;
  if (!required.empty()) with["required"] = required;

  Json schema;
  schema["properties"]["from"] = schema_of_from(step);
  schema["properties"]["with"] = with;
  Json keys = Json::array();
  for (const InputDescription& input : step.inputs)
    if (!input.optional) {
      keys.push_back("from");
      break;
    }
  if (!required.empty()) keys.push_back("with");
  if (!keys.empty()) schema["required"] = keys;
  return schema;
}

}  // namespace plumb::pipeline
