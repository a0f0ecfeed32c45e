#include "plumb/pipeline/bind/values.hpp"

#include <algorithm>

#include "plumb/pipeline/bind/former.hpp"

namespace plumb::pipeline {
namespace {

std::vector<std::string> names_of(const Settings& settings) {
  std::vector<std::string> all;
  all.reserve(settings.size());
  for (const auto& [name, setting] : settings) all.push_back(name);
  return all;
}

/// By the names of now.
ParameterValue value_of_now(const Reading& reading, const SettingValue& given) {
  const auto now = reading.now.find(given.written);
  return now == reading.now.end() ? *given.value : ParameterValue(now->second);
}

OrFaulty<Value> value_of_setting(Reading& reading, const Settings& settings,
                                 const std::string& place, const ParameterDescription& parameter,
                                 const Node& node, const std::string& name) {
  const auto at = settings.find(name);
  if (at == settings.end()) {
    reading.uses.dangling = true;
    const std::string hint = did_you_mean(name, names_of(settings));
    reading.fault(node.origin, place + ": nothing is called '$" + name + "'.",
                  hint + (hint.empty() ? "" : "  ") + how_to_write_a_dollar);
    return Faulty();
  }
  reading.uses.settings.insert(name);
  if (!at->second.value) return Faulty();
  const SettingValue& given = *at->second.value;
  if (!given.value) return Value{ParameterValue(), given.origin};  // left open
  const auto value = converted(given.type, value_of_now(reading, given), parameter);
  if (const auto* fault = std::get_if<Fault>(&value)) {
    reading.fault(node.origin, place + ": '$" + name + "' does not serve: " + fault->sentence + ".",
                  "Its value is from " + given.origin.text() + ".");
    return Faulty();
  }
  return Value{std::get<ParameterValue>(value), given.origin};
}

/// What is written there, by the names of now.
std::variant<ParameterValue, Fault> read_by_now(const Reading& reading,
                                                const ParameterDescription& parameter,
                                                const Node& node) {
  const auto now = reading.now.find(&node);
  if (now == reading.now.end()) return read_value(parameter, node);
  Node copy = node;
  copy.text = now->second;
  return read_value(parameter, copy);
}

}  // namespace

OrFaulty<Value> value_of(Reading& reading, const Settings& settings, const std::string& place,
                         const ParameterDescription& parameter, const Node& node) {
  if (const auto reference = reference_in(node))
    return value_of_setting(reading, settings, place, parameter, node,
                            setting_of_now(reading, settings, node, *reference));
  const auto value = read_by_now(reading, parameter, node);
  if (const auto* fault = std::get_if<Fault>(&value)) {
    reading.fault(node.origin, place + ": " + fault->sentence + ".", fault->hint);
    return Faulty();
  }
  return Value{std::get<ParameterValue>(value), node.origin};
}

bool check_keys(Diagnostics& diagnostics, const Node& node, const std::string& what,
                const std::vector<std::string>& known) {
  if (!node.is_map()) {
    diagnostics.add(node.origin, what + ": expected a map, found " + node.shown() + ".",
                    "Keys: " + joined(known) + ".");
    return false;
  }
  for (const Entry& entry : node.entries)
    if (std::find(known.begin(), known.end(), entry.key) == known.end())
      diagnostics.add(entry.origin, what + ": unknown key '" + entry.key + "'.",
                      did_you_mean(entry.key, known));
  return true;
}

}  // namespace plumb::pipeline
