/// How a manifest is read: all of it by name first. What it defines is registered in the end and
/// together, so that one that is refused leaves nothing behind.
#include <limits>
#include <set>
#include <utility>

#include "plumb/data/error.hpp"
#include "plumb/plugin/manifest.hpp"
#include "plumb/plugin/manifest_words.hpp"
#include "plumb/plugin/registry.hpp"

namespace plumb {
namespace {

using json = ManifestJson;

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

/// A step whose types and kind are meant by their names.
struct StepDraft {
  StepDescription step;
  std::optional<std::string> items;
  std::vector<std::string> inputs, outputs;  ///< types, by port
};

std::optional<std::string> kind_name(const json& j) {
  return j.is_null() ? std::nullopt : std::optional(j.get<std::string>());
}

StepDraft step_draft(const json& j) {
  StepDraft draft;
  StepDescription& s = draft.step;
  s.name = j.at("name");
  s.version = whole_of<int>(j.at("version"));
  s.across_builds = j.value("across_builds", false);
  draft.items = kind_name(j.at("items"));
  s.summary = j.at("summary");
  s.source = j.at("source");
  for (const auto& p : j.at("inputs")) {
    draft.inputs.push_back(p.at("type"));
    s.inputs.push_back({p.at("name"), nullptr, by_place<Access>(accesses, p.at("access")),
                        p.at("optional"), p.at("doc"), p.at("sees")});
  }
  for (const auto& p : j.at("outputs")) {
    draft.outputs.push_back(p.at("type"));
    s.outputs.push_back({p.at("name"), nullptr, by_place<Emission>(emissions, p.at("emission")),
                         p.at("doc"), p.at("over")});
  }
  for (const auto& p : j.at("parameters")) s.parameters.push_back(parameter_of(p));
  return draft;
}

ItemKind kind_of(const json& j) {
  return {j.at("name"), j.at("parts"), j.at("ranges"),
          j.at("ends"), j.at("list"),  j.at("transient")};
}

TypeDraft type_draft(const json& j) {
  return {{.name = j.at("name"),
           .version = whole_of<int>(j.at("version")),
           .large = j.at("large"),
           .has_numbers = j.at("has_numbers"),
           .has_empty = j.at("has_empty"),
           .layout = j.at("layout")},
          kind_name(j.at("items"))};
}

/// What a manifest holds beside its licence, nothing of it registered.
struct Draft {
  std::vector<ItemKind> kinds;
  std::vector<TypeDraft> types;
  std::vector<StepDraft> steps;
};

Draft draft_of(const json& j) {
  Draft draft;
  for (const json& kind : j.at("kinds")) draft.kinds.push_back(kind_of(kind));
  for (const json& type : j.at("types")) draft.types.push_back(type_draft(type));
  for (const json& step : j.at("steps")) draft.steps.push_back(step_draft(step));
  return draft;
}

/// What steps name is defined in the manifest, or was before.
void require_defined(const Draft& draft) {
  std::set<std::string> kinds, types;
  for (const ItemKind& kind : draft.kinds) kinds.insert(kind.name);
  for (const TypeDraft& type : draft.types) types.insert(type.type.name);
  const auto require_type = [&](const std::string& name) {
    if (!types.contains(name) && !find_type(name))
      throw Error("type '" + name + "' is named and not defined");
  };
  for (const StepDraft& step : draft.steps) {
    if (step.items && !kinds.contains(*step.items) && !find_kind(*step.items))
      throw Error("item kind '" + *step.items + "' is named and not defined");
    for (const std::string& name : step.inputs) require_type(name);
    for (const std::string& name : step.outputs) require_type(name);
  }
}

/// A step whose types and kind are registered.
StepDescription joined(StepDraft draft) {
  StepDescription step = std::move(draft.step);
  if (draft.items) step.items = find_kind(*draft.items);
  for (std::size_t k = 0; k < step.inputs.size(); ++k)
    step.inputs[k].type = find_type(draft.inputs[k]);
  for (std::size_t k = 0; k < step.outputs.size(); ++k)
    step.outputs[k].type = find_type(draft.outputs[k]);
  return step;
}

Licence licence_of(const json& j) {
  if (!j.contains("licence")) return {};
  const json& stated = j.at("licence");
  Licence licence{stated.at("expression"), stated.at("reason")};
  if (const std::string fault = fault_of_licence(licence.expression); !fault.empty())
    throw Error(fault);
  return licence;
}

}  // namespace

Manifest read_manifest(const std::string& text, const std::string& file) {
  try {
    const json j = json::parse(text);
    if (j.at("plumb_manifest") != manifest_version)
      throw Error("made for another version of Plumb");
    Manifest manifest{j.at("abi"), {}, licence_of(j)};
    if (manifest.abi_tag != abi_tag()) return manifest;  // what it defines may be something else
    Draft draft = draft_of(j);
    require_defined(draft);
    define_together(draft.kinds, draft.types);
    for (StepDraft& step : draft.steps) manifest.steps.push_back(joined(std::move(step)));
    return manifest;
  } catch (const std::exception& e) {
    throw Error(file + ": not a manifest that can be used: " + e.what() +
                "; build the module again");
  }
}

}  // namespace plumb
