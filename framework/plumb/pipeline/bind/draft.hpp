#pragma once
/// A pipeline in the making: the tree, the names in it, and the Plan as far as it is known. Each
/// pass over it is one file.

#include <deque>
#include <map>
#include <optional>
#include <set>

#include "plumb/pipeline/bind/plan.hpp"
#include "plumb/pipeline/yaml/renamer.hpp"
#include "plumb/pipeline/yaml/tree.hpp"
#include "plumb/pipeline/yaml/value.hpp"
#include "plumb/plugin/registry.hpp"

namespace plumb::pipeline {

/// What a name in `steps` (or in `carry`) stands for.
struct Symbol {
  enum class Kind { step, group, repeat, carry };
  Kind kind = Kind::step;
  int index =
      -1;  ///< of the step; of the group's scope; of the repeat; of the carry in its scope's repeat
  Origin origin;
};

/// Names that are looked up together: of the whole pipeline, of a group, of a repeat's body.
struct Scope {
  std::string path;  ///< "" for the pipeline
  int parent = -1;
  int repeat = -1;  ///< the innermost repeat whose body this lies in
  std::map<std::string, Symbol, std::less<>> names;
  std::set<std::string>
      broken;  ///< names of what is neither step, group nor repeat, which was told
};

struct DraftStep {
  const Node* node = nullptr;
  int scope = -1, repeat = -1;
  int sequence = 0;  ///< in the order written
  bool used = false;
  bool misspelt = false;  ///< has a key that is none: what it lacks may be meant by it
};

/// One output that a reference may mean.
struct Source {
  Wire wire;
  const Type* type = nullptr;
  const ItemKind* grain = nullptr;  ///< null: one value of the pipeline
};

struct DraftRow {
  std::vector<const Node*> values;
  bool used = false;
};
struct DraftCarry {
  const Node* start = nullptr;
  const Node* next = nullptr;
  bool used = false, found = false;
  std::vector<std::pair<Source, Source>>
      pairs;  ///< start and next of one type each; the first user picks
  const Type* chosen = nullptr;
};
struct DraftRepeat {
  const Node* node = nullptr;
  int scope = -1, body = -1,
      parent = -1;  ///< scope it stands in, scope of its body, repeat around it
  int sequence = 0;
  std::vector<DraftRow> rows;
  std::vector<DraftCarry> carries;
};

/// A parameter of the pipeline with its value.
struct Setting {
  ParameterDescription type;
  std::optional<ParameterValue> value;
  Origin origin, declared;
  bool used = false;
  bool faulty = false;  ///< already told
};

struct Draft {
  const Registry& registry;
  Diagnostics& diagnostics;
  Renamer& names;
  Node tree;
  std::set<std::string> referenced = {};  ///< Loaded::referenced
  bool open = false;
  Plan plan = {};
  std::vector<Scope> scopes = {};
  std::vector<DraftStep> steps = {};      ///< as plan.steps
  std::vector<DraftRepeat> repeats = {};  ///< as plan.repeats
  std::map<std::string, Setting> settings = {};
  bool dangling =
      false;  ///< something that was written leads nowhere: what it meant only looks unused
  std::map<const Node*, std::string> rewritten = {};  ///< nodes of the tree by the names of now
  std::deque<Node> renamed = {};                      ///< copies of such nodes

  void fault(const Origin& origin, std::string sentence, std::string hint = "") {
    diagnostics.add(origin, std::move(sentence), std::move(hint));
  }
  /// "step 'thin' (filter.voxel_grid)".
  std::string title(int step) const {
    const PlannedStep& s = plan.steps[step];
    return "step '" + s.path + "'" + (s.description ? " (" + s.description->name + ")" : "");
  }
};

/// Reports keys that are not `known`; false when `node` is no map.
bool check_keys(Draft& draft, const Node& node, const std::string& what,
                const std::vector<std::string>& known);

/// The value that `node` writes, or refers to by $name: a pipeline parameter, or a row of the
/// repeats around (then `planned` gets the row). Faults are told as "PLACE: ...".
std::optional<ParameterValue> value_of(Draft& draft, const std::string& place,
                                       const ParameterDescription& parameter, const Node& node,
                                       int repeat, PlannedParameter* planned);

/// The outputs that a reference from `scope` may mean; nothing when it is wrong (told) or leads to
/// an unknown step.
std::optional<std::vector<Source>> sources_of(Draft& draft, int scope, const Node& reference);
/// Marks a source as used, and settles the type of what a repeat carries. False when it cannot be
/// (told).
bool choose(Draft& draft, const Source& source);
/// What a source is, for sentences: "Features, one per segment".
std::string kind_of(const Type& type, const ItemKind* grain);
/// The row of the repeats from `repeat` outwards that has this name.
std::optional<std::pair<int, int>> find_row(const Draft& draft, const std::string& name,
                                            int repeat);
/// Whether a repeat is `inside` of another or the same; -1 is the pipeline.
bool inside(const Draft& draft, int repeat, int of);

/// Notes that a node is read as `now` (yaml/renamer.hpp).
void rename(Draft& draft, const Node& node, const std::string& now);
/// What a node says by the names of now.
const std::string& text_of_now(const Draft& draft, const Node& node);
/// The parameter or row that "$name" at `node` means, by its name of now.
std::string setting_of_now(Draft& draft, const Node& node, const std::string& name, int repeat);
/// `node`, or a copy with the choice by its name of now; of a row or parameter that it refers to
/// the values are replaced.
const Node& choice_of_now(Draft& draft, int step, const ParameterDescription& parameter,
                          const Node& node);
/// Puts what was noted into the tree.
void rewrite(Draft& draft);

/// Letters, digits and '_', a letter first.
bool valid_name(std::string_view name);
/// Adds a name to a scope. A name that an outer scope has too is refused: nobody could say which is
/// meant.
bool declare(Draft& draft, int scope, const std::string& name, const Symbol& symbol);
/// Rows, carried values and counts of one repeat.
void read_passes(Draft& draft, int repeat);

void read_settings(Draft& draft);    ///< header and parameters
void read_steps(Draft& draft);       ///< steps, groups and repeats get names
void read_parameters(Draft& draft);  ///< `with` of every step, rows
void read_wires(Draft& draft);       ///< `from` of every step, carries
void read_conditions(Draft& draft);  ///< `until`

}  // namespace plumb::pipeline
