#include <algorithm>
#include <functional>

#include "plumb/pipeline/yaml/load.hpp"
#include "plumb/pipeline/yaml/value.hpp"

namespace plumb::pipeline {
namespace fs = std::filesystem;
namespace {

bool applied(const std::vector<fs::path>& done, const fs::path& file) {
  return std::find(done.begin(), done.end(), file) != done.end();
}

/// `file` as a path that is written in the file `from`.
std::string relative_to(const fs::path& from, const fs::path& file) {
  return followed(file).lexically_relative(followed(from).parent_path()).string();
}

/// What lies over no pipeline.
bool lone_overlay(const Node& tree, Diagnostics& diagnostics) {
  if (tree.at("steps")) return false;
  for (const char* key : {"remove", "replace", "add", "set"})
    if (const Entry* entry = tree.find(key)) {
      diagnostics.add(
          entry->origin,
          "'" + std::string(key) + "' changes a pipeline, and this file does not say which.",
          "Add 'extends: PIPELINE.yaml', a path relative to this file.");
      return true;
    }
  return false;
}

/// The edits under 'also' of a file for one of the pipelines `done`, or null.
const Node* also_for(const Chain::Link& link, const std::vector<fs::path>& done) {
  const Node* also = link.tree.at("also");
  if (!also || !also->is_map()) return nullptr;
  for (const Entry& entry : also->entries)
    if (applied(done, followed(link.canonical.parent_path() / entry.key))) return &entry.value;
  return nullptr;
}

/// Adds what the steps below `node` refer to; `rows` are those of the repeats around it, the inner
/// ones last, each with its path.
void collect_references(const Node& node, const std::string& path, std::vector<std::string> rows,
                        std::set<std::string>& found) {
  if (const Node* repeat = node.at("repeat"))
    if (const Node* passes = repeat->at("passes"))
      for (const std::string& row : passes->keys()) rows.push_back(path + "." + row);
  const auto add = [&](const Node& value) {
    const auto name = reference_in(value);
    if (!name) return;
    const auto row = std::find_if(rows.rbegin(), rows.rend(), [&](const std::string& each) {
      return each.substr(each.rfind('.') + 1) == *name;
    });
    found.insert(row == rows.rend() ? *name : *row);
  };
  const std::function<void(const Node&)> visit = [&](const Node& value) {
    add(value);
    for (const Node& item : value.items) visit(item);
    for (const Entry& entry : value.entries) visit(entry.value);
  };
  for (const Entry& entry : node.entries) {
    if (entry.key != "steps") {
      visit(entry.value);
    } else {
      for (const Entry& step : entry.value.entries)
        collect_references(step.value, path.empty() ? step.key : path + "." + step.key, rows,
                           found);
    }
  }
}

void collect_references(Loaded& loaded) {
  collect_references(loaded.tree, "", {}, loaded.referenced);
}

/// A pipeline and all that is laid over it, one file after the other.
class Stack {
 public:
  Stack(const Overlay& overlay, Renamer& names, Diagnostics& diagnostics)
      : overlay_(overlay), names_(names), diagnostics_(diagnostics) {}

  std::optional<Loaded> of(const fs::path& file) {
    Chain chain = read_chain(file, {}, overlay_.texts, diagnostics_);
    if (chain.links.empty() || lone_overlay(chain.links.front().tree, diagnostics_))
      return std::nullopt;
    loaded_.tree = std::move(chain.links.front().tree);
    names_.read_pipeline(loaded_.tree);
    done_.push_back(chain.links.front().canonical);
    loaded_.files.push_back(chain.links.front().file);
    for (std::size_t k = 1; k < chain.links.size(); ++k) lay_over(chain.links[k]);
    for (const fs::path& preset : overlay_.presets) stack(preset);
    for (const Edits& edits : overlay_.edits) lay_over(edits);
    collect_references(loaded_);
    apply_sets(loaded_.tree, overlay_.sets, names_, diagnostics_);
    return std::move(loaded_);
  }

 private:
  void lay_over(Chain::Link& link) {
    names_.read_overlay(link.tree);
    collect_references(loaded_);
    apply_overlay(loaded_.tree, link.tree, names_, diagnostics_);
    done_.push_back(link.canonical);
    loaded_.files.push_back(link.file);
  }

  void lay_over(const Edits& edits) {
    if (edits.text) diagnostics_.read(edits.tree.origin.file, *edits.text);
    Node tree = edits.tree;
    names_.read_overlay(tree);
    collect_references(loaded_);
    apply_also(loaded_.tree, tree, names_, diagnostics_);
  }

  /// Lays over what of a preset's chain is not there yet.
  void stack(const fs::path& preset) {
    const std::string& pipeline = loaded_.files.front();
    Chain chain = read_chain(preset, pipeline, overlay_.texts, diagnostics_);
    if (chain.links.empty()) return;
    if (chain.links.size() == 1)
      return diagnostics_.add({chain.links.back().file, 1, 1},
                              "a preset extends a pipeline, and this file extends none.",
                              "Write 'extends: " + relative_to(chain.links.back().file, pipeline) +
                                  "', or run the file by itself.");
    if (!applied(done_, chain.links.front().canonical)) return stack_also(chain);
    for (Chain::Link& link : chain.links)
      if (!applied(done_, link.canonical)) lay_over(link);
  }

  /// A preset of another pipeline, by what it names under 'also'.
  void stack_also(Chain& chain) {
    bool any = false;
    for (Chain::Link& link : chain.links) {
      if (!also_for(link, done_)) continue;
      any = true;
      if (applied(done_also_, link.canonical)) continue;
      done_also_.push_back(link.canonical);
      names_.read_overlay(link.tree);
      collect_references(loaded_);
      apply_also(loaded_.tree, *also_for(link, done_), names_, diagnostics_);
      loaded_.files.push_back(link.file);
    }
    if (!any)
      diagnostics_.add(chain.links[1].tree.at("extends")->origin,
                       "this preset extends '" + chain.links.front().file +
                           "', not the pipeline '" + loaded_.files.front() + "'.",
                       "Run it by itself, or name the edits for that pipeline in it under 'also'.");
  }

  const Overlay& overlay_;
  Renamer& names_;
  Diagnostics& diagnostics_;
  Loaded loaded_;
  std::vector<fs::path> done_, done_also_;
};

}  // namespace

std::optional<Loaded> load_pipeline(const fs::path& file, const Overlay& overlay, Renamer& names,
                                    Diagnostics& diagnostics) {
  return Stack(overlay, names, diagnostics).of(file);
}

}  // namespace plumb::pipeline
