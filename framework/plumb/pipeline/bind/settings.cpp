/// The pipeline's header and its parameters; and how any value is read that may be a reference.
#include <algorithm>
#include <cmath>

#include "plumb/pipeline/bind/draft.hpp"

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

void read_choices(Draft& draft, const std::string& place, const Node& node,
                  ParameterDescription& type) {
  const Node* of = node.at("of");
  if (type.kind != ParameterKind::choice) {
    if (of) draft.fault(of->origin, place + ": only a choice has 'of'.");
    return;
  }
  if (!of || !of->is_list() || of->items.empty())
    return draft.fault(of ? of->origin : node.origin,
                       place + ": a choice lists its values in 'of'.",
                       "As in of: [huber, cauchy].");
  for (const Node& item : of->items) {
    if (item.is_scalar())
      type.choices.push_back({item.text, ""});
    else
      draft.fault(item.origin, place + ": expected a word, found " + item.shown() + ".");
  }
}

void read_setting(Draft& draft, const Entry& entry) {
  const std::string place = "parameter '" + entry.key + "'";
  const Node& node = entry.value;
  Setting setting;
  setting.declared = entry.origin;
  setting.faulty = true;
  Setting& kept = draft.settings[entry.key] = setting;
  if (!check_keys(draft, node, place, {"type", "of", "default", "about"})) return;

  std::vector<std::string> known;
  for (const TypeName& t : type_names) known.emplace_back(t.name);
  const Node* type = node.at("type");
  const auto found = std::find_if(
      std::begin(type_names), std::end(type_names),
      [&](const TypeName& t) { return type && type->is_scalar() && type->text == t.name; });
  if (found == std::end(type_names)) {
    if (!type)
      draft.fault(entry.origin, place + ": 'type' is missing.", "One of " + joined(known) + ".");
    else
      draft.fault(type->origin, place + ": there is no type " + type->shown() + ".",
                  did_you_mean(type->text, known));
    return;
  }
  kept.type.name = entry.key;
  kept.type.kind = found->kind;
  kept.type.quantity = found->quantity;
  kept.type.may_be_none = true;  // whether a step takes none is the step's to say
  kept.type.low = -INFINITY;
  kept.type.high = INFINITY;
  read_choices(draft, place, node, kept.type);

  const Node* about = node.at("about");
  if (about && !about->is_scalar()) draft.fault(about->origin, place + ": 'about' is a sentence.");
  const Node* value = node.at("default");
  kept.origin = value ? value->origin : entry.origin;
  if (value && reference_in(*value))
    return draft.fault(value->origin,
                       place + ": " + value->shown() +
                           " refers to another, and the value of a parameter stands for itself.",
                       how_to_write_a_dollar);
  if (value) {
    auto read = read_value(kept.type, *value);
    if (const auto* fault = std::get_if<Fault>(&read))
      return draft.fault(value->origin, place + ": " + fault->sentence + ".", fault->hint);
    kept.value = std::get<ParameterValue>(read);
  } else if (!draft.open) {
    return draft.fault(entry.origin, place + ": it has no default, and no value was given.",
                       "Give one: --set " + entry.key + "=VALUE.");
  }
  kept.faulty = false;
  draft.plan.settings.push_back(
      {entry.key, about ? about->text : "", value ? value->text : "", kept.origin});
}

std::string text_under(Draft& draft, const char* key) {
  const Node* node = draft.tree.at(key);
  if (!node) return "";
  if (!node->is_scalar())
    draft.fault(node->origin, "'" + std::string(key) + "' is text, found " + node->shown() + ".");
  return node->text;
}

std::vector<std::string> names_of(const std::map<std::string, Setting>& settings) {
  std::vector<std::string> all;
  all.reserve(settings.size());
  for (const auto& [name, setting] : settings) all.push_back(name);
  return all;
}

}  // namespace

bool check_keys(Draft& draft, const Node& node, const std::string& what,
                const std::vector<std::string>& known) {
  if (!node.is_map()) {
    draft.fault(node.origin, what + ": expected a map, found " + node.shown() + ".",
                "Keys: " + joined(known) + ".");
    return false;
  }
  for (const Entry& entry : node.entries)
    if (std::find(known.begin(), known.end(), entry.key) == known.end())
      draft.fault(entry.origin, what + ": unknown key '" + entry.key + "'.",
                  did_you_mean(entry.key, known));
  return true;
}

void read_settings(Draft& draft) {
  const Node& tree = draft.tree;
  check_keys(draft, tree, "the pipeline", {"plumb", "name", "about", "parameters", "steps"});
  const Node* version = tree.at("plumb");
  if (!version)
    draft.fault({tree.origin.file, 1, 1},
                "'plumb: 1' is missing: it says which grammar this file follows.");
  else if (!version->is_scalar() || version->text != "1")
    draft.fault(version->origin, "this is Plumb's grammar 1, found " + version->shown() + ".",
                "Write 'plumb: 1'.");
  draft.plan.name = text_under(draft, "name");
  draft.plan.about = text_under(draft, "about");
  if (draft.plan.name.empty())
    draft.plan.name = std::filesystem::path(draft.plan.files.front()).stem().string();
  const Node* parameters = tree.at("parameters");
  if (!parameters) return;
  if (!parameters->is_map())
    return draft.fault(parameters->origin,
                       "'parameters' is a map of names, found " + parameters->shown() + ".");
  for (const Entry& entry : parameters->entries) read_setting(draft, entry);
}

std::optional<std::pair<int, int>> find_row(const Draft& draft, const std::string& name,
                                            int repeat) {
  for (; repeat >= 0; repeat = draft.repeats[repeat].parent) {
    const auto& rows = draft.plan.repeats[repeat].rows;
    for (std::size_t k = 0; k < rows.size(); ++k)
      if (rows[k].name == name) return std::pair(repeat, static_cast<int>(k));
  }
  return std::nullopt;
}

namespace {

std::optional<ParameterValue> setting_value(Draft& draft, const std::string& place,
                                            const ParameterDescription& parameter, const Node& node,
                                            const std::string& name, PlannedParameter* planned) {
  const auto at = draft.settings.find(name);
  if (at == draft.settings.end()) {
    draft.dangling = true;
    const std::string hint = did_you_mean(name, names_of(draft.settings));
    draft.fault(node.origin, place + ": nothing is called '$" + name + "'.",
                hint + (hint.empty() ? "" : "  ") + how_to_write_a_dollar);
    return std::nullopt;
  }
  Setting& setting = at->second;
  setting.used = true;
  if (setting.faulty) return std::nullopt;
  if (planned) planned->origin = setting.origin;
  if (!setting.value) return ParameterValue();  // only when the draft is open
  auto value = converted(setting.type, *setting.value, parameter);
  if (const auto* fault = std::get_if<Fault>(&value)) {
    draft.fault(node.origin, place + ": '$" + name + "' does not serve: " + fault->sentence + ".",
                "Its value is from " + setting.origin.text() + ".");
    return std::nullopt;
  }
  return std::get<ParameterValue>(value);
}

/// Reads a row for one more parameter that it drives; the first one says what it holds.
std::optional<ParameterValue> row_value(Draft& draft, const std::string& place,
                                        const ParameterDescription& parameter, int repeat,
                                        int index, PlannedParameter* planned) {
  PlannedRow& row = draft.plan.repeats[repeat].rows[index];
  DraftRow& drafted = draft.repeats[repeat].rows[index];
  const bool first = !drafted.used;
  drafted.used = true;
  if (!first && (row.kind != parameter.kind || row.quantity != parameter.quantity)) {
    draft.fault(row.origin,
                place + ": the row '" + row.name + "' drives " + expected(parameter) +
                    " here and something else elsewhere.",
                "Use two rows.");
    return std::nullopt;
  }
  row.kind = parameter.kind;
  row.quantity = parameter.quantity;
  std::vector<ParameterValue> values;
  for (const Node* node : drafted.values) {
    const auto value =
        value_of(draft, place + ": row '" + row.name + "'", parameter, *node, -1, nullptr);
    if (value) values.push_back(*value);
  }
  if (values.size() != drafted.values.size() || values.empty()) return std::nullopt;
  row.values = values;
  planned->repeat = repeat;
  planned->row = index;
  planned->origin = row.origin;
  return values.front();
}

}  // namespace

std::optional<ParameterValue> value_of(Draft& draft, const std::string& place,
                                       const ParameterDescription& parameter, const Node& node,
                                       int repeat, PlannedParameter* planned) {
  if (const auto reference = reference_in(node)) {
    const std::string name = setting_of_now(draft, node, *reference, planned ? repeat : -1);
    if (planned)
      if (const auto row = find_row(draft, name, repeat))
        return row_value(draft, place, parameter, row->first, row->second, planned);
    return setting_value(draft, place, parameter, node, name, planned);
  }
  auto value = read_value(parameter, node);
  if (const auto* fault = std::get_if<Fault>(&value)) {
    draft.fault(node.origin, place + ": " + fault->sentence + ".", fault->hint);
    return std::nullopt;
  }
  if (planned) planned->origin = node.origin;
  return std::get<ParameterValue>(value);
}

}  // namespace plumb::pipeline
