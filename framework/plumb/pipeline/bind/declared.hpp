#pragma once
/// The first stage behind the tree: all that has a name is known, and no reference is followed yet.

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "plumb/pipeline/bind/or_faulty.hpp"
#include "plumb/pipeline/bind/plan.hpp"
#include "plumb/pipeline/bind/reading.hpp"
#include "plumb/pipeline/yaml/load.hpp"
#include "plumb/plugin/registry.hpp"

namespace plumb::pipeline {

/// What a name in `steps` (or in `carry`) stands for.
struct Symbol {
  enum class Kind { step, group, repeat, carry };
  Kind kind = Kind::step;
  int index =
      -1;  ///< of the step; of the group's scope; of the repeat; of the carry in its scope's repeat
  Origin origin = {};
};

/// Names that are looked up together: of the whole pipeline, of a group, of a repeat's body.
struct Scope {
  std::string path = {};  ///< "" for the pipeline
  int parent = -1;
  int repeat = -1;  ///< the innermost repeat whose body this lies in
  /// Faulty: what is neither step, group nor repeat.
  std::map<std::string, OrFaulty<Symbol>, std::less<>> names = {};

  /// What a name stands for, or null: there is none, or it is faulty.
  const Symbol* find(std::string_view name) const;
  bool has_faulty(std::string_view name) const;
};

/// The value of a parameter of the pipeline.
struct SettingValue {
  ParameterDescription type;
  std::optional<ParameterValue> value;  ///< nothing where it was left open
  const Node* written = nullptr;        ///< null where it was left open
  Origin origin;
};

/// A parameter of the pipeline.
struct Setting {
  const Node* node = nullptr;  ///< its declaration
  Origin declared;
  OrFaulty<SettingValue> value = Faulty();
};
using Settings = std::map<std::string, Setting, std::less<>>;

/// What a step uses, and what can only be judged then.
struct Use {
  const StepDescription* description = nullptr;
  OnError on_error = OnError::stop;
};

struct DeclaredStep {
  const Node* node = nullptr;
  std::string path;  ///< "coarse.matches"
  Origin origin;
  int scope = -1, repeat = -1;
  int sequence = 0;              ///< in the order written
  OrFaulty<Use> use = Faulty();  ///< faulty: no module offers it
  bool misspelt = false;         ///< has a key that is none: what it lacks may be meant by it

  /// "step 'thin' (filter.voxel_grid)".
  std::string title() const;
};

struct DeclaredRow {
  std::string name;
  std::vector<const Node*> values;
  Origin origin;
};
struct DeclaredCarry {
  std::string name;
  OrFaulty<const Node*> start;  ///< faulty: 'start' does not say
  const Node* next = nullptr;
};
struct Counts {
  int columns = 1;                ///< of the rows
  int at_least = 2, at_most = 1;  ///< passes
  Exhausted if_exhausted = Exhausted::warn;
};
/// What a repeat says of its passes.
struct Passes {
  std::vector<DeclaredRow> rows = {};
  std::vector<DeclaredCarry> carries = {};
  OrFaulty<Counts> counts = Faulty();
};

struct DeclaredRepeat {
  const Node* node = nullptr;
  std::string path;
  Origin origin;
  int scope = -1, body = -1,
      parent = -1;  ///< scope it stands in, scope of its body, repeat around it
  int sequence = 0;
  Passes passes = {};
};

struct Declared {
  std::shared_ptr<const Loaded> loaded;  ///< holds the nodes that are pointed to
  std::string name, about;
  Settings settings;
  std::vector<Scope> scopes;  ///< the pipeline's first
  std::vector<DeclaredStep> steps;
  std::vector<DeclaredRepeat> repeats;
  Uses uses;       ///< by counts of repeats
  NamesOfNow now;  ///< in counts of repeats
};

/// `open`: parameters without a value are no mistake.
Declared declare(std::shared_ptr<const Loaded> loaded, bool open, const Registry& registry,
                 Renamer& names, Diagnostics& diagnostics);

/// The row of the repeats from `repeat` outwards that has this name.
std::optional<std::pair<int, int>> find_row(const Declared& declared, const std::string& name,
                                            int repeat);
/// Whether a repeat is `inside` of another or the same; -1 is the pipeline.
bool inside(const Declared& declared, int repeat, int of);

}  // namespace plumb::pipeline
