#include "plumb/slam/experiment/cell_plan.hpp"

#include <algorithm>

#include "plumb/data/error.hpp"
#include "plumb/data/file_name.hpp"
#include "plumb/data/io/file_text.hpp"
#include "plumb/pipeline/reader.hpp"
#include "plumb/pipeline/yaml/value.hpp"
#include "plumb/slam/experiment/replicate.hpp"

namespace plumb::experiment {

namespace fs = std::filesystem;

namespace {

std::string name_in(const std::string& set) { return set.substr(0, set.find('=')); }

/// Adds a set, in the place of an earlier one of the same name.
void put(std::vector<std::string>& sets, const std::string& set) {
  std::erase_if(sets, [&](const std::string& other) { return name_in(other) == name_in(set); });
  sets.push_back(set);
}

bool declares(const Plan& plan, const std::string& name) {
  return std::ranges::any_of(plan.settings,
                             [&](const PlannedSetting& setting) { return setting.name == name; });
}

/// What the input sets by itself.
std::vector<std::string> sets_of(const Input& input, const Plan& open, const std::string& variant) {
  if (!declares(open, "input"))
    throw Error(open.files.front() + ": has no parameter 'input' that " + input.where +
                " could set; declare one under 'parameters'");
  if (!fs::exists(input.path))
    throw Error(input.where +
                ": there is no such file or folder; give a log, or the folder of a sequence");
  const auto set = [](const std::string& name, const fs::path& file) {
    return name + "=" + pipeline::dollars_doubled(fs::absolute(file).string());
  };
  if (!fs::is_directory(input.path)) return {set("input", input.path)};
  const auto log = input.path / "log.clf";
  std::vector<std::string> sets{set("input", fs::exists(log) ? log : input.path)};
  for (const auto& [name, file] : {std::pair<const char*, std::string>{"truth", "truth.tum"},
                                   {"plan", "plan.txt"},
                                   {"estimate", variant + ".tum"}})
    if (declares(open, name) && fs::exists(input.path / file))
      sets.push_back(set(name, input.path / file));
  return sets;
}

/// The edits of an input that the pipeline has a parameter for; all of them where the pipeline is
/// the experiment's own.
std::vector<Edits> edits_of(const Input& input, const Variant& variant, const Plan& open) {
  std::vector<Edits> all = input.edits;
  if (variant.alone())
    for (Edits& edits : all)
      if (pipeline::Node* set = edits.tree.at("set"))
        std::erase_if(set->entries,
                      [&](const pipeline::Entry& entry) { return !declares(open, entry.key); });
  return all;
}

/// What is set of a run but by its replicate, later ones first obeyed.
std::vector<std::string> sets_of_run(const Experiment& experiment, const Variant& variant,
                                     const Input& input, const Plan& open) {
  std::vector<std::string> sets = sets_of(input, open, variant.name);
  for (const Edits& edits : input.edits)
    if (const pipeline::Node* set = edits.tree.at("set"))
      for (const std::string& name : set->keys())
        std::erase_if(sets, [&](const std::string& own) { return name_in(own) == name; });
  if (!variant.alone())
    for (const std::string& set : experiment.sets) put(sets, set);
  for (const std::string& set : variant.sets) put(sets, set);
  for (const auto& swept : variant.swept)
    std::erase_if(sets, [&](const std::string& set) { return name_in(set) == swept.first; });
  return sets;
}

}  // namespace

std::vector<Variant> all_variants(const Experiment& experiment, const Registry& registry) {
  Overlay open;
  open.open = true;
  open.edits = experiment.edits;
  open.sets = experiment.sets;
  const Plan pipeline = read_pipeline(experiment.pipeline, open, registry);
  std::vector<Variant> variants(1);
  variants.front().name = pipeline.name;
  for (const Variant& variant : experiment.variants) variants.push_back(variant);
  for (Variant& variant : swept_variants(experiment.axes, experiment.sweep_by))
    variants.push_back(std::move(variant));
  for (std::size_t v = 0; v < variants.size(); ++v) {
    const std::string& name = variants[v].name;
    if (const std::string fault = fault_of_file_name(name); !fault.empty())
      throw Error((v == 0 ? pipeline.files.front() + ": its name " : "the variant ") +
                  io::in_quotes(name) + ", of which compare makes a folder, " + fault);
    for (std::size_t w = 0; w < v; ++w)
      if (variants[w].name == name)
        throw Error("variant '" + name + "': there is a '" + name + "' already" +
                    (w == 0 ? ", the pipeline as it is" : "") +
                    "; give each variant a name of its own");
  }
  return variants;
}

Plan cell_plan(const Experiment& experiment, const Variant& variant, const Input& input,
               std::size_t replicate, const Registry& registry) {
  const fs::path& file = variant.alone() ? variant.pipeline : experiment.pipeline;
  Overlay overlay;
  overlay.presets = variant.presets;
  if (!variant.alone()) overlay.edits = experiment.edits;
  overlay.edits.insert(overlay.edits.end(), variant.edits.begin(), variant.edits.end());
  overlay.open = true;
  const Plan open = read_pipeline(file, overlay, registry);
  for (Edits& edits : edits_of(input, variant, open)) overlay.edits.push_back(std::move(edits));
  overlay.sets = sets_of_run(experiment, variant, input, open);
  for (const std::string& set : disturbances(experiment.replicates, replicate, input.name, open))
    put(overlay.sets, set);
  overlay.open = false;
  overlay.needs_files = true;
  return read_pipeline(file, overlay, registry);
}

void require_disturbable(const Experiment& experiment, const std::vector<Variant>& variants,
                         const std::vector<const Plan*>& plans) {
  if (experiment.replicates.count < 2) return;
  std::vector<std::string> everywhere;  // what no variant has
  for (std::size_t v = 0; v < plans.size(); ++v) {
    const auto lacking = not_disturbed(experiment.replicates, *plans[v]);
    for (const std::string& name : lacking)
      if (name == "skip_frames" || name == "drop_frames")
        throw Error("replicates: no step of variant '" + variants[v].name + "' has a parameter '" +
                    name + "', so that not all variants would see the same frames; leave '" + name +
                    "' out of what the replicates disturb");
    if (v == 0)
      everywhere = lacking;
    else
      std::erase_if(everywhere, [&](const std::string& name) {
        return std::ranges::find(lacking, name) == lacking.end();
      });
  }
  if (!everywhere.empty())
    throw Error("replicates: no step of any variant has a parameter '" + everywhere.front() +
                "'; leave it out of what the replicates disturb");
}

}  // namespace plumb::experiment
