/// How a manifest is written; read back: manifest_read.cpp.
#include "plumb/plugin/manifest.hpp"

#include <cmath>
#include <map>

#include "plumb/plugin/manifest_words.hpp"

namespace plumb {
namespace {

using json = ManifestJson;

json value_json(const ParameterValue& value) {
  return std::visit(
      [](const auto& v) -> json {
        if constexpr (std::is_same_v<std::decay_t<decltype(v)>, std::monostate>)
          return nullptr;
        else
          return v;
      },
      value);
}

json bound_json(double bound) { return std::isfinite(bound) ? json(bound) : json(nullptr); }

json parameter_json(const ParameterDescription& p) {
  json j = {{"name", p.name},
            {"kind", name_of(p.kind)},
            {"quantity", name_of(p.quantity)},
            {"si_unit", si_symbol(p.quantity)},
            {"required", p.required},
            {"may_be_none", p.may_be_none},
            {"default", value_json(p.standard)},
            {"low", bound_json(p.low)},
            {"high", bound_json(p.high)},
            {"doc", p.doc},
            {"source", p.source},
            {"affects_result", p.affects_result}};
  for (const Choice& c : p.choices) j["choices"].push_back({{"name", c.name}, {"doc", c.doc}});
  return j;
}

json to_json(const StepDescription& s) {
  json j = {{"name", s.name},
            {"version", s.version},
            {"across_builds", s.across_builds},
            {"items", s.items ? json(s.items->name) : json(nullptr)},
            {"summary", s.summary},
            {"source", s.source}};
  j["inputs"] = j["outputs"] = j["parameters"] = json::array();
  for (const auto& port : s.inputs)
    j["inputs"].push_back({{"name", port.name},
                           {"type", port.type->name},
                           {"access", accesses[static_cast<int>(port.access)]},
                           {"optional", port.optional},
                           {"doc", port.doc},
                           {"sees", port.sees}});
  for (const auto& port : s.outputs)
    j["outputs"].push_back({{"name", port.name},
                            {"type", port.type->name},
                            {"emission", emissions[static_cast<int>(port.emission)]},
                            {"over", port.over},
                            {"doc", port.doc}});
  for (const auto& p : s.parameters) j["parameters"].push_back(parameter_json(p));
  return j;
}

json kind_json(const ItemKind& kind) {
  return {{"name", kind.name}, {"parts", kind.parts}, {"ranges", kind.ranges},
          {"ends", kind.ends}, {"list", kind.list},   {"transient", kind.transient}};
}

json type_json(const Type& type) {
  return {{"name", type.name},
          {"version", type.version},
          {"items", type.kind ? json(type.kind->name) : json(nullptr)},
          {"large", type.large},
          {"has_numbers", type.has_numbers},
          {"has_empty", type.has_empty},
          {"layout", type.layout}};
}

/// The types of all ports, and the kinds that they and the steps are of.
void add_definitions(json& j, const std::vector<StepDescription>& steps) {
  std::map<std::string, const Type*> types;
  std::map<std::string, const ItemKind*> kinds;
  for (const StepDescription& step : steps) {
    for (const auto& port : step.inputs) types[port.type->name] = port.type;
    for (const auto& port : step.outputs) types[port.type->name] = port.type;
    if (step.items) kinds[step.items->name] = step.items;
  }
  for (const auto& [name, type] : types)
    if (type->kind) kinds[type->kind->name] = type->kind;
  j["kinds"] = j["types"] = json::array();
  for (const auto& [name, kind] : kinds) j["kinds"].push_back(kind_json(*kind));
  for (const auto& [name, type] : types) j["types"].push_back(type_json(*type));
}

json licence_json(const Licence& licence) {
  return {{"expression", licence.expression}, {"reason", licence.reason}};
}

std::string dumped(const json& j) { return j.dump(2, ' ', true, json::error_handler_t::replace); }

}  // namespace

std::string step_json(const StepDescription& step) { return dumped(to_json(step)); }

std::string step_json(const StepDescription& step, const Licence& licence) {
  json j = to_json(step);
  j["licence"] = licence.expression.empty() ? json(nullptr) : licence_json(licence);
  return dumped(j);
}

std::string manifest_text(const Manifest& manifest) {
  json j = {{"plumb_manifest", manifest_version}, {"abi", manifest.abi_tag}};
  if (!manifest.licence.expression.empty()) j["licence"] = licence_json(manifest.licence);
  add_definitions(j, manifest.steps);
  j["steps"] = json::array();
  for (const auto& step : manifest.steps) j["steps"].push_back(to_json(step));
  return j.dump(1) + "\n";
}

}  // namespace plumb
