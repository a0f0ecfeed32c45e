#include "plumb/plugin/manifest.hpp"

#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>

#include "plumb/data/error.hpp"
#include "plumb/plugin/registry.hpp"

namespace plumb {
namespace {

using json = nlohmann::ordered_json;

constexpr int manifest_version = 3;

constexpr const char* accesses[] = {"item", "ends", "each", "several", "part"};
constexpr const char* emissions[] = {"one", "many", "lazy"};
constexpr ParameterKind parameter_kinds[] = {ParameterKind::number,  ParameterKind::integer,
                                             ParameterKind::boolean, ParameterKind::text,
                                             ParameterKind::path,    ParameterKind::choice};
constexpr Quantity quantities[] = {
    Quantity::none,          Quantity::length,    Quantity::angle,
    Quantity::time,          Quantity::ratio,     Quantity::speed,
    Quantity::angular_speed, Quantity::curvature, Quantity::frequency};

template <class E, std::size_t N>
E by_name(const E (&values)[N], const std::string& name) {
  for (const E value : values)
    if (name == name_of(value)) return value;
  throw Error("'" + name + "' is unknown here");
}
template <class E, std::size_t N>
E by_place(const char* const (&names)[N], const std::string& name) {
  for (std::size_t k = 0; k < N; ++k)
    if (name == names[k]) return static_cast<E>(k);
  throw Error("'" + name + "' is unknown here");
}

/// A number with a fraction or beyond what W holds would otherwise be cut to something.
template <class W>
W whole_of(const json& j) {
  const bool whole =
      j.is_number_integer() && !(j.is_number_unsigned() &&
                                 j.get<std::uint64_t>() > std::numeric_limits<std::int64_t>::max());
  if (!whole || !std::in_range<W>(j.get<std::int64_t>()))
    throw Error("a whole number is expected where something else or a larger one stands");
  return static_cast<W>(j.get<std::int64_t>());
}

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

ParameterValue value_of(const json& j, ParameterKind kind) {
  if (j.is_null()) return std::monostate{};
  switch (kind) {
    case ParameterKind::number:
      return j.get<double>();
    case ParameterKind::integer:
      return whole_of<std::int64_t>(j);
    case ParameterKind::boolean:
      return j.get<bool>();
    default:
      return j.get<std::string>();
  }
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

ParameterDescription parameter_of(const json& j) {
  ParameterDescription p;
  p.name = j.at("name");
  p.kind = by_name(parameter_kinds, j.at("kind"));
  p.quantity = by_name(quantities, j.at("quantity"));
  p.required = j.at("required");
  p.may_be_none = j.at("may_be_none");
  p.standard = value_of(j.at("default"), p.kind);
  constexpr double open = std::numeric_limits<double>::infinity();
  p.low = j.at("low").is_null() ? -open : j.at("low").get<double>();
  p.high = j.at("high").is_null() ? open : j.at("high").get<double>();
  p.doc = j.at("doc");
  p.source = j.at("source");
  p.affects_result = j.at("affects_result");
  if (j.contains("choices"))
    for (const auto& c : j.at("choices")) p.choices.push_back({c.at("name"), c.at("doc")});
  return p;
}

json to_json(const StepDescription& s) {
  json j = {{"name", s.name},
            {"version", s.version},
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

const ItemKind* kind_named(const json& j) {
  if (j.is_null()) return nullptr;
  const std::string name = j;
  if (const ItemKind* kind = find_kind(name)) return kind;
  throw Error("item kind '" + name + "' is named and not defined");
}

const Type* type_named(const json& j) {
  const std::string name = j;
  if (const Type* type = find_type(name)) return type;
  throw Error("type '" + name + "' is named and not defined");
}

/// Kinds before the types of their values, so that both can be registered in their order.
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

/// Registers what a manifest defines, so that its steps can be wired before any code is loaded.
void define_all(const json& j) {
  for (const json& k : j.at("kinds"))
    define_kind({k.at("name"), k.at("parts"), k.at("ranges"), k.at("ends"), k.at("list"),
                 k.at("transient")});
  for (const json& t : j.at("types"))
    define_type({.name = t.at("name"),
                 .version = whole_of<int>(t.at("version")),
                 .kind = kind_named(t.at("items")),
                 .large = t.at("large"),
                 .has_numbers = t.at("has_numbers"),
                 .has_empty = t.at("has_empty"),
                 .layout = t.at("layout")});
}

StepDescription step_of(const json& j) {
  StepDescription s;
  s.name = j.at("name");
  s.version = whole_of<int>(j.at("version"));
  s.items = kind_named(j.at("items"));
  s.summary = j.at("summary");
  s.source = j.at("source");
  for (const auto& p : j.at("inputs"))
    s.inputs.push_back({p.at("name"), type_named(p.at("type")),
                        by_place<Access>(accesses, p.at("access")), p.at("optional"), p.at("doc"),
                        p.at("sees")});
  for (const auto& p : j.at("outputs"))
    s.outputs.push_back({p.at("name"), type_named(p.at("type")),
                         by_place<Emission>(emissions, p.at("emission")), p.at("doc"),
                         p.at("over")});
  for (const auto& p : j.at("parameters")) s.parameters.push_back(parameter_of(p));
  return s;
}

json licence_json(const Licence& licence) {
  return {{"expression", licence.expression}, {"reason", licence.reason}};
}

Licence licence_of(const json& j) {
  if (!j.contains("licence")) return {};
  const json& stated = j.at("licence");
  Licence licence{stated.at("expression"), stated.at("reason")};
  if (const std::string fault = fault_of_licence(licence.expression); !fault.empty())
    throw Error(fault);
  return licence;
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

Manifest read_manifest(const std::string& text, const std::string& file) {
  try {
    const json j = json::parse(text);
    if (j.at("plumb_manifest") != manifest_version)
      throw Error("made for another version of Plumb");
    Manifest manifest{j.at("abi"), {}, licence_of(j)};
    if (manifest.abi_tag != abi_tag()) return manifest;  // what it defines may be something else
    define_all(j);
    for (const auto& step : j.at("steps")) manifest.steps.push_back(step_of(step));
    return manifest;
  } catch (const std::exception& e) {
    throw Error(file + ": not a manifest that can be used: " + e.what() +
                "; build the module again");
  }
}

}  // namespace plumb
