#pragma once
/// What a step says of itself, as plain data: checks, `plumb inspect`, the JSON Schema and the
/// manifest read only this.

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <variant>
#include <vector>

#include "plumb/data/type.hpp"
#include "plumb/plugin/unit.hpp"

namespace plumb {

/// How a step looks at one of its inputs.
enum class Access {
  item,     ///< the value of the same item; or the one value of the pipeline
  ends,     ///< the values of the two items that an item joins
  each,     ///< all values in order, opened one at a time (of a step on items with parts: its own)
  several,  ///< any number of values, each with a label
  part,     ///< of one value of the pipeline what concerns the item alone
};

struct InputDescription {
  std::string name;
  const Type* type = nullptr;
  Access access = Access::item;
  bool optional = false;
  std::string doc;
  std::string sees;  ///< of a part, for people: "only T_i_j of the edge"
};

/// One value a call; many at once (one per segment); or many, made when they are asked for.
enum class Emission { one, many, lazy };

struct OutputDescription {
  std::string name;
  const Type* type = nullptr;
  Emission emission = Emission::one;
  std::string doc;
  std::string over;  ///< of many: the input whose items they belong to, one value each; empty: they
                     ///< are new items
};

enum class ParameterKind { number, integer, boolean, text, path, choice };
const char* name_of(ParameterKind kind);

/// A parameter's value in SI. monostate is 'none', for parameters that may be left open.
using ParameterValue = std::variant<std::monostate, bool, std::int64_t, double, std::string>;
using ParameterValues = std::map<std::string, ParameterValue>;

struct Choice {
  std::string name, doc;
};

struct ParameterDescription {
  std::string name;
  ParameterKind kind = ParameterKind::number;
  Quantity quantity = Quantity::none;
  bool may_be_none = false;
  bool required = false;        ///< has no default
  ParameterValue standard;      ///< the default, unless required
  double low, high;             ///< inclusive, SI; infinite where open
  std::vector<Choice> choices;  ///< of kind choice
  std::string doc, source;
  bool affects_result = true;  ///< false: not part of an item's key
};

struct StepDescription {
  std::string name;                 ///< FAMILY.NAME
  int version = 1;                  ///< raised when the same input gives another result
  const ItemKind* items = nullptr;  ///< one call each; null: one call on whole collections
  std::string summary;              ///< one line
  std::string source;               ///< paper and section
  std::string module;               ///< file it was loaded from; empty in a test
  /// Which build of its code it is (build_identity.hpp): results are known by it, so that those of
  /// an edited kernel are never taken for its own. Empty in a test.
  std::string build;
  bool across_builds = false;  ///< results are known by `version` alone
  std::vector<InputDescription> inputs;
  std::vector<OutputDescription> outputs;
  std::vector<ParameterDescription> parameters;

  bool itemwise() const { return items != nullptr; }
  /// "SegmentStep", "WholeStep".
  std::string base() const;
  /// Whether an input says which items there are: of the type that lists them.
  bool lists_items(const InputDescription& input) const {
    return items && input.access == Access::part && input.type->name == items->list;
  }

  const InputDescription* input(std::string_view name) const;
  const OutputDescription* output(std::string_view name) const;
  const ParameterDescription* parameter(std::string_view name) const;
};

/// The value as YAML writes it: `0.3 m`, `true`, `none`.
std::string written(const ParameterDescription& parameter, const ParameterValue& value);

/// Type, unit and range for people: "length, 1 cm to 100 m".
std::string range_text(const ParameterDescription& parameter);

/// Empty when `value` is of the right kind and in range, else what was expected.
std::string fault_of(const ParameterDescription& parameter, const ParameterValue& value);

}  // namespace plumb
