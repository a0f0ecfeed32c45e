/// Experiments in files: YAML to an Experiment.
#include <algorithm>

#include "plumb/data/file_name.hpp"
#include "plumb/data/io/file_text.hpp"
#include "plumb/pipeline/yaml/load.hpp"
#include "plumb/slam/experiment/experiment.hpp"
#include "plumb/slam/experiment/values.hpp"

namespace plumb::experiment {

namespace fs = std::filesystem;
using pipeline::Diagnostics, pipeline::Entry, pipeline::Node;

namespace {

constexpr std::uint64_t largest_experiment = 1 << 20;  // [byte]
constexpr double most_replicates = 1000;
constexpr std::size_t most_axes = 20, most_row_values = 100;

const std::vector<std::string> edit_keys = {"remove", "replace", "add", "set"};

class Reader : Values {
 public:
  using Values::Values;

  Experiment read(const Node& tree) {
    static const std::vector<std::string> known = {
        "experiment", "name",   "about",    "pipeline",         "set",
        "variants",   "sweep",  "sweep_by", "inputs",           "replicates",
        "primary",    "margin", "metrics",  "higher_is_better", "time"};
    Experiment made;
    if (!is_map(tree, "an experiment", known)) return made;
    require_version(tree);
    made.name = text_at(tree, "name");
    if (made.name.empty()) made.name = file_.stem().string();
    made.about = text_at(tree, "about");
    made.pipeline = pipeline_of(tree);
    if (const Node* set = tree.at("set")) made.edits = {edits_of(only_set(*set))};
    if (const Node* variants = tree.at("variants")) made.variants = variants_of(*variants, made);
    read_sweep(tree, made);
    if (const Node* inputs = tree.at("inputs")) made.inputs = inputs_of(*inputs);
    if (const Node* replicates = tree.at("replicates"))
      made.replicates = replicates_of(*replicates);
    read_rules(tree, made);
    return made;
  }

 private:
  void require_version(const Node& tree) {
    const Node* version = tree.at("experiment");
    if (!version || !version->is_scalar() || version->text != "1")
      fault(
          version ? version->origin : begin(),
          "expected 'experiment: 1', which says that this is an experiment and by which grammar.");
  }

  fs::path pipeline_of(const Node& tree) {
    if (tree.at("pipeline")) return path_of(text_at(tree, "pipeline"));
    fault(begin(), "'pipeline' is missing: what the variants are variants of.",
          "As in pipeline: ../plumb.yaml, relative to this file.");
    return {};
  }

  /// The edits among the keys of a map.
  Edits edits_of(const Node& map) const {
    Edits edits{map, text_};
    std::erase_if(edits.tree.entries, [](const Entry& entry) {
      return std::ranges::find(edit_keys, entry.key) == edit_keys.end();
    });
    return edits;
  }
  static Node only_set(const Node& set) {
    Node map;
    map.kind = Node::Kind::map;
    map.origin = set.origin;
    map.put("set", set.origin, set);
    return map;
  }

  std::vector<Variant> variants_of(const Node& node, const Experiment& of) {
    std::vector<Variant> variants;
    if (!node.is_map()) {
      fault(node.origin, "'variants' is a map of names, found " + node.shown() + ".",
            "As in variants: {coarse: {set: {voxel_size: 0.5 m}}}.");
      return variants;
    }
    for (const Entry& entry : node.entries) variants.push_back(variant_of(entry, of));
    return variants;
  }

  Variant variant_of(const Entry& entry, const Experiment& of) {
    const std::string what = "variant '" + entry.key + "'";
    Variant variant{.name = entry.key};
    if (const std::string wrong = fault_of_file_name(entry.key); !wrong.empty())
      fault(entry.origin, what + " " + wrong + ".");
    if (entry.value.is_scalar()) {
      take_file(variant, path_of(text_of(entry.value, what)), of.pipeline);
      return variant;
    }
    std::vector<std::string> known = edit_keys;
    known.insert(known.begin(), "file");
    if (!is_map(entry.value, what, known)) return variant;
    for (const std::string& file : texts_of(entry.value.at("file"), "'file' of " + what))
      if (!file.empty()) take_file(variant, path_of(file), of.pipeline);
    Edits edits = edits_of(entry.value);
    if (!edits.tree.entries.empty()) variant.edits.push_back(std::move(edits));
    return variant;
  }

  void read_sweep(const Node& tree, Experiment& to) {
    if (const Node* by = tree.at("sweep_by")) {
      const auto word = word_of(*by, "'sweep_by'", {"grid", "paired", "one_at_a_time"});
      to.sweep_by = word == "grid"     ? SweepBy::grid
                    : word == "paired" ? SweepBy::paired
                                       : SweepBy::one_at_a_time;
    }
    const Node* sweep = tree.at("sweep");
    if (!sweep) return;
    if (!sweep->is_map())
      return fault(sweep->origin, "'sweep' is a map of parameters, found " + sweep->shown() + ".",
                   "As in sweep: {voxel_size: [0.2 m, 0.3 m]}.");
    if (sweep->entries.size() > most_axes)
      return fault(sweep->origin, "a sweep of more than 20 parameters is nobody's to read.");
    for (const Entry& entry : sweep->entries) {
      if (entry.value.is_list() && !entry.value.items.empty())
        to.axes.push_back({entry.key, entry.origin, entry.value.items, text_});
      else
        fault(entry.value.origin, "a sweep of '" + entry.key + "' takes a list of values, found " +
                                      entry.value.shown() + ".");
      for (const Node& value : entry.value.items)
        if (!is_value(value))
          fault(value.origin, "a value of '" + entry.key +
                                  "' is expected, or a list of up to 100 for a row, found " +
                                  value.shown() + ".");
    }
  }

  /// What a parameter or a row can be set to.
  static bool is_value(const Node& node) {
    if (node.is_scalar()) return true;
    return node.is_list() && !node.items.empty() && node.items.size() <= most_row_values &&
           std::ranges::all_of(node.items, [](const Node& item) { return item.is_scalar(); });
  }

  std::vector<Input> inputs_of(const Node& node) {
    std::vector<Input> inputs;
    if (!node.is_list()) {
      fault(node.origin, "'inputs' is a list, found " + node.shown() + ".",
            "As in inputs: [../street, {path: ../mall, set: {truth: ../mall.tum}}].");
      return inputs;
    }
    for (const Node& item : node.items) inputs.push_back(input_of(item));
    std::vector<fs::path> paths;
    for (const Input& input : inputs)
      paths.push_back(input.path.empty() ? fs::path("?") : input.path);  // the mistake is told
    const auto names = names_of(paths);
    for (std::size_t k = 0; k < inputs.size(); ++k)
      if (inputs[k].name.empty()) inputs[k].name = names[k];
    for (std::size_t k = 0; k < inputs.size(); ++k)
      for (std::size_t n = 0; n < k; ++n)
        if (inputs[k].name == inputs[n].name)
          fault(node.items[k].origin, "there is an input '" + inputs[k].name + "' already.",
                "First at " + node.items[n].origin.text() + ".");
    return inputs;
  }

  Input input_of(const Node& item) {
    Input input;
    const bool map = item.is_map();
    if (map && is_map(item, "an input", {"path", "name", "set"})) {
      input.name = text_at(item, "name");
      if (!item.at("path")) fault(item.origin, "'path' of the input is missing.");
      if (item.at("set")) input.edits = {edits_of(item)};
    }
    const std::string path = map ? text_at(item, "path") : text_of(item, "an input");
    input.path = path_of(path);
    input.where = item.origin.text() + ": input '" + path + "'";
    if (const std::string wrong = fault_of_file_name(input.name);
        !input.name.empty() && !wrong.empty())
      fault(item.origin, "'" + input.name + "' " + wrong + ".");
    return input;
  }

  Replicates replicates_of(const Node& node) {
    Replicates replicates;
    const auto count = [&](const Node& n) {
      return static_cast<std::size_t>(
          integer_of(n, "'count' of the replicates", 1, most_replicates));
    };
    if (node.is_scalar()) {
      replicates.count = count(node);
      replicates.disturb_all();
      return replicates;
    }
    if (!is_map(node, "'replicates'",
                {"count", "seed", "skip_frames", "drop_frames", "phase", "seeds"}))
      return replicates;
    if (const Node* n = node.at("count"))
      replicates.count = count(*n);
    else
      fault(node.origin, "'count' of the replicates is missing.",
            "As in replicates: {count: 5, phase: true}.");
    if (const Node* n = node.at("seed"))
      replicates.seed =
          static_cast<std::uint64_t>(integer_of(*n, "'seed' of the replicates", 0, 1e9));
    if (const Node* n = node.at("skip_frames"))
      replicates.skip_frames = static_cast<std::uint32_t>(integer_of(*n, "'skip_frames'", 0, 1e6));
    if (const Node* n = node.at("drop_frames"))
      replicates.drop_frames = ratio_of(*n, "'drop_frames'", 0, 0.9);
    if (const Node* n = node.at("phase")) replicates.phase = boolean_of(*n, "'phase'");
    if (const Node* n = node.at("seeds")) replicates.seeds = boolean_of(*n, "'seeds'");
    const bool says = std::ranges::any_of(node.entries, [](const Entry& entry) {
      return entry.key != "count" && entry.key != "seed";
    });
    if (!says) replicates.disturb_all();
    if (says && replicates.count > 1 && replicates.disturb_nothing())
      fault(
          node.origin,
          "replicates that disturb nothing are one run again and again: a run gives the same each "
          "time.",
          "Name what they disturb: skip_frames, drop_frames, phase, seeds.");
    return replicates;
  }

  void read_rules(const Node& tree, Experiment& to) {
    if (tree.at("primary"))
      to.primary = text_at(tree, "primary");
    else
      fault(begin(), "'primary' is missing: the one number that decides is named before the runs.",
            "As in primary: error.fine.ate.");
    if (const Node* margin = tree.at("margin"))
      to.margin = ratio_of(*margin, "'margin'", 0.0001, 0.5);
    to.metrics = texts_of(tree.at("metrics"), "'metrics'");
    to.higher_is_better = texts_of(tree.at("higher_is_better"), "'higher_is_better'");
    if (const Node* time = tree.at("time")) {
      to.timed = texts_of(time, "'time'");
      to.timed_where = time->origin.text() + ": 'time'";
    }
  }
};

}  // namespace

void take_file(Variant& variant, const fs::path& file, const fs::path& pipeline) {
  Diagnostics ignored;
  const std::size_t links = pipeline::read_chain(file, pipeline, {}, ignored).links.size();
  if (links == 1)
    variant.pipeline = file;
  else
    variant.presets.push_back(file);
}

std::vector<std::string> names_of(const std::vector<fs::path>& paths) {
  std::vector<std::string> names;
  for (const fs::path& given : paths) {
    fs::path path = fs::absolute(given).lexically_normal();
    if (path.filename().empty()) path = path.parent_path();
    const std::string last = path.filename().string();
    std::string name = last;
    for (int k = 2; std::ranges::find(names, name) != names.end(); ++k)
      name = last + "_" + std::to_string(k);
    names.push_back(name);
  }
  return names;
}

Experiment read_experiment(const fs::path& file) {
  Diagnostics diagnostics;
  const auto text = std::make_shared<const std::string>(
      io::FileBytes(file, largest_experiment, "experiment").view());
  const auto tree = pipeline::parse_yaml(*text, file.string(), diagnostics);
  if (!tree) diagnostics.raise();
  Experiment experiment = Reader(file, text, diagnostics).read(*tree);
  diagnostics.raise();
  return experiment;
}

}  // namespace plumb::experiment
