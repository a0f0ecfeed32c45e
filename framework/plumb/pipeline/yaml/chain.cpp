#include <algorithm>
#include <functional>

#include "plumb/data/error.hpp"
#include "plumb/data/io/fence.hpp"
#include "plumb/data/io/file_text.hpp"
#include "plumb/data/io/regular_file.hpp"
#include "plumb/pipeline/yaml/foreign_file.hpp"
#include "plumb/pipeline/yaml/load.hpp"
#include "plumb/pipeline/yaml/value.hpp"

namespace plumb::pipeline {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t longest_chain = 16;
constexpr std::uint64_t largest_file = 1 << 20;

/// A path with its links followed; as it is written where they lead round in a circle.
fs::path followed(const fs::path& path) {
  std::error_code error;
  fs::path real = fs::weakly_canonical(path, error);
  return error ? path.lexically_normal() : real;
}

std::optional<std::string> text_of(const fs::path& file, const fs::path& pipeline,
                                   const Origin& asked, Diagnostics& diagnostics) {
  std::error_code error;
  const auto refuse = [&](const Fault& fault) {
    diagnostics.add(asked, fault.sentence, fault.hint);
    return std::nullopt;
  };
  if (!io::inside_of_fence(file))
    return refuse({"'" + file.string() +
                       "' lies outside of the folders of the pipeline and presets that were given, "
                       "and --untrusted reads nothing else.",
                   "Name the pipeline itself and lay the preset over it (--preset), or leave "
                   "--untrusted out."});
  const std::string name = "'" + file.string() + "' ";
  if (fs::is_directory(file, error)) return refuse(foreign_folder(file));
  if (!fs::exists(file, error))
    return refuse({"there is no file " + name.substr(0, name.size() - 1) + ".",
                   cure_for_missing(file, pipeline)});
  if (const std::string other = io::other_than_file(file); !other.empty())
    return refuse(
        {name + "is " + other + ", not a pipeline.", "Give the path of a pipeline (YAML)."});
  std::string text, why;
  try {
    text = io::FileBytes(file, largest_file, "pipeline").view();
  } catch (const Error& e) {
    why = std::string(e.what()).substr(file.string().size() + 2) + ".";  // behind "FILE: "
  }
  if (!why.empty()) return refuse({name + why, ""});
  if (const auto fault = foreign_file(file, text)) return refuse(*fault);
  return text;
}

/// Appends `file` after what it extends; a preset is laid over `pipeline`. False when something
/// cannot be read.
bool follow(const fs::path& file, const fs::path& pipeline, const Origin& asked,
            std::vector<fs::path>& open, Chain& chain, Diagnostics& diagnostics) {
  const fs::path canonical = followed(file);
  if (std::find(open.begin(), open.end(), canonical) != open.end() ||
      open.size() >= longest_chain) {
    const bool loop = open.size() < longest_chain;
    diagnostics.add(asked,
                    "'" + file.string() +
                        (loop ? "' extends itself." : "' is extended over more than 16 files."),
                    loop ? "Let it extend a pipeline." : "Lay some of them together in one.");
    return false;
  }
  open.push_back(canonical);
  const auto text = text_of(file, pipeline, asked, diagnostics);
  if (!text) return false;
  auto tree = parse_yaml(*text, file.string(), diagnostics);
  if (!tree) return false;
  if (!tree->is_map()) {
    diagnostics.add(tree->origin,
                    "expected a map with 'plumb: 1' and 'steps', found " + tree->shown() + ".");
    return false;
  }
  if (const Node* base = tree->at("extends")) {
    if (!base->is_scalar() || base->text.empty()) {
      diagnostics.add(base->origin, "'extends' takes one path, found " + base->shown() + ".");
      return false;
    }
    const fs::path next = (file.parent_path() / base->text).lexically_normal();
    if (!follow(next, pipeline, base->origin, open, chain, diagnostics)) return false;
  }
  chain.links.push_back({canonical, file.string(), std::move(*tree)});
  return true;
}

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

/// Lays over what of a preset's chain is not there yet.
void stack(const fs::path& preset, Loaded& loaded, std::vector<fs::path>& done,
           std::vector<fs::path>& done_also, Diagnostics& diagnostics) {
  std::vector<std::string>& files = loaded.files;
  const Chain chain = read_chain(preset, files.front(), diagnostics);
  if (chain.links.empty()) return;
  const Origin origin{chain.links.back().file, 1, 1};
  if (chain.links.size() == 1) {
    diagnostics.add(origin, "a preset extends a pipeline, and this file extends none.",
                    "Write 'extends: " + relative_to(chain.links.back().file, files.front()) +
                        "', or run the file by itself.");
    return;
  }
  if (!applied(done, chain.links.front().canonical)) {
    bool any = false;
    for (const auto& link : chain.links)
      if (const Node* edits = also_for(link, done)) {
        any = true;
        if (applied(done_also, link.canonical)) continue;
        done_also.push_back(link.canonical);
        collect_references(loaded);
        apply_also(loaded.tree, *edits, diagnostics);
        files.push_back(link.file);
      }
    if (any) return;
    diagnostics.add(chain.links[1].tree.at("extends")->origin,
                    "this preset extends '" + chain.links.front().file + "', not the pipeline '" +
                        files.front() + "'.",
                    "Run it by itself, or name the edits for that pipeline in it under 'also'.");
    return;
  }
  for (const auto& link : chain.links) {
    if (applied(done, link.canonical)) continue;
    collect_references(loaded);
    apply_overlay(loaded.tree, link.tree, diagnostics);
    done.push_back(link.canonical);
    files.push_back(link.file);
  }
}

}  // namespace

Chain read_chain(const fs::path& file, const fs::path& pipeline, Diagnostics& diagnostics) {
  Chain chain;
  std::vector<fs::path> open;
  if (!follow(file.lexically_normal(), pipeline, {file.string(), 0, 0}, open, chain, diagnostics))
    chain.links.clear();
  return chain;
}

std::optional<Loaded> load_pipeline(const fs::path& file, const Overlay& overlay,
                                    Diagnostics& diagnostics) {
  Chain chain = read_chain(file, {}, diagnostics);
  if (chain.links.empty() || lone_overlay(chain.links.front().tree, diagnostics))
    return std::nullopt;
  Loaded loaded{chain.links.front().tree, {}, {}};
  std::vector<fs::path> done;
  for (const auto& link : chain.links) {
    if (!done.empty()) {
      collect_references(loaded);
      apply_overlay(loaded.tree, link.tree, diagnostics);
    }
    done.push_back(link.canonical);
    loaded.files.push_back(link.file);
  }
  std::vector<fs::path> done_also;
  for (const fs::path& preset : overlay.presets)
    stack(preset, loaded, done, done_also, diagnostics);
  collect_references(loaded);
  std::vector<std::string> seen;
  for (const std::string& option : overlay.sets) {
    const std::string key = option.substr(0, option.find('='));
    if (std::find(seen.begin(), seen.end(), key) != seen.end())
      diagnostics.add({"--set " + option, 0, 0}, "'" + key + "' is set twice on the command line.");
    seen.push_back(key);
    apply_set(loaded.tree, option, diagnostics);
  }
  return loaded;
}

}  // namespace plumb::pipeline
