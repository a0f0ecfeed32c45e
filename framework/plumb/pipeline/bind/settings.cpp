/// The pipeline's parameters: their types, and their values as they are written.
#include <algorithm>
#include <cmath>

#include "plumb/pipeline/bind/declaring.hpp"
#include "plumb/pipeline/bind/values.hpp"

namespace plumb::pipeline {
namespace {

struct TypeName {
  const char* name;
  ParameterKind kind;
  Quantity quantity;
};
constexpr TypeName type_names[] = {
    {"path", ParameterKind::path, Quantity::none},
    {"length", ParameterKind::number, Quantity::length},
    {"angle", ParameterKind::number, Quantity::angle},
    {"time", ParameterKind::number, Quantity::time},
    {"ratio", ParameterKind::number, Quantity::ratio},
    {"speed", ParameterKind::number, Quantity::speed},
    {"angular_speed", ParameterKind::number, Quantity::angular_speed},
    {"curvature", ParameterKind::number, Quantity::curvature},
    {"frequency", ParameterKind::number, Quantity::frequency},
    {"number", ParameterKind::number, Quantity::none},
    {"integer", ParameterKind::integer, Quantity::none},
    {"boolean", ParameterKind::boolean, Quantity::none},
    {"text", ParameterKind::text, Quantity::none},
    {"choice", ParameterKind::choice, Quantity::none},
};

/// The type that is declared, or null (told).
const TypeName* type_at(const Entry& entry, const std::string& place, Diagnostics& diagnostics) {
  const Node* type = entry.value.at("type");
  const auto* found = std::find_if(
      std::begin(type_names), std::end(type_names),
      [&](const TypeName& t) { return type && type->is_scalar() && type->text == t.name; });
  if (found != std::end(type_names)) return found;
  std::vector<std::string> known;
  for (const TypeName& t : type_names) known.emplace_back(t.name);
  if (!type)
    diagnostics.add(entry.origin, place + ": 'type' is missing.", "One of " + joined(known) + ".");
  else
    diagnostics.add(type->origin, place + ": there is no type " + type->shown() + ".",
                    did_you_mean(type->text, known));
  return nullptr;
}

std::vector<Choice> choices_of(const Node& node, ParameterKind kind, const std::string& place,
                               Diagnostics& diagnostics) {
  std::vector<Choice> choices;
  const Node* of = node.at("of");
  if (kind != ParameterKind::choice) {
    if (of) diagnostics.add(of->origin, place + ": only a choice has 'of'.");
    return choices;
  }
  if (!of || !of->is_list() || of->items.empty()) {
    diagnostics.add(of ? of->origin : node.origin, place + ": a choice lists its values in 'of'.",
                    "As in of: [huber, cauchy].");
    return choices;
  }
  for (const Node& item : of->items) {
    if (item.is_scalar())
      choices.push_back({item.text, ""});
    else
      diagnostics.add(item.origin, place + ": expected a word, found " + item.shown() + ".");
  }
  return choices;
}

/// What is given: of the type that is filled in.
OrFaulty<SettingValue> given(SettingValue value, const Entry& entry, const std::string& place,
                             bool open, Diagnostics& diagnostics) {
  const Node* written = entry.value.at("default");
  value.written = written;
  value.origin = written ? written->origin : entry.origin;
  const auto refuse = [&](const std::string& sentence, const std::string& hint) {
    diagnostics.add(value.origin, place + ": " + sentence, hint);
    return Faulty();
  };
  if (!written && open) return value;
  if (!written)
    return refuse("it has no default, and no value was given.",
                  "Give one: --set " + entry.key + "=VALUE.");
  if (reference_in(*written))
    return refuse(
        written->shown() + " refers to another, and the value of a parameter stands for itself.",
        how_to_write_a_dollar);
  const auto read = read_value(value.type, *written);
  if (const auto* fault = std::get_if<Fault>(&read))
    return refuse(fault->sentence + ".", fault->hint);
  value.value = std::get<ParameterValue>(read);
  return value;
}

OrFaulty<SettingValue> setting_value(const Entry& entry, bool open, Diagnostics& diagnostics) {
  const std::string place = "parameter '" + entry.key + "'";
  const Node& node = entry.value;
  if (!check_keys(diagnostics, node, place, {"type", "of", "default", "about"})) return Faulty();
  const TypeName* type = type_at(entry, place, diagnostics);
  if (!type) return Faulty();
  SettingValue value;
  value.type.name = entry.key;
  value.type.kind = type->kind;
  value.type.quantity = type->quantity;
  value.type.may_be_none = true;  // whether a step takes none is the step's to say
  value.type.low = -INFINITY;
  value.type.high = INFINITY;
  value.type.choices = choices_of(node, type->kind, place, diagnostics);
  const Node* about = node.at("about");
  if (about && !about->is_scalar())
    diagnostics.add(about->origin, place + ": 'about' is a sentence.");
  return given(std::move(value), entry, place, open, diagnostics);
}

}  // namespace

Settings settings_of(const Node& tree, bool open, Diagnostics& diagnostics) {
  Settings settings;
  const Node* parameters = tree.at("parameters");
  if (!parameters) return settings;
  if (!parameters->is_map()) {
    diagnostics.add(parameters->origin,
                    "'parameters' is a map of names, found " + parameters->shown() + ".");
    return settings;
  }
  for (const Entry& entry : parameters->entries)
    settings.insert_or_assign(
        entry.key, Setting{&entry.value, entry.origin, setting_value(entry, open, diagnostics)});
  return settings;
}

}  // namespace plumb::pipeline
