#include <algorithm>

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
            const Overlay::Texts& texts, std::vector<fs::path>& open, Chain& chain,
            Diagnostics& diagnostics) {
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
  const auto instead = texts.find(file);
  const auto text = instead != texts.end() ? std::optional(instead->second)
                                           : text_of(file, pipeline, asked, diagnostics);
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
    if (!follow(next, pipeline, base->origin, texts, open, chain, diagnostics)) return false;
  }
  chain.links.push_back({canonical, file.string(), std::move(*tree)});
  return true;
}

}  // namespace

fs::path followed(const fs::path& path) {
  std::error_code error;
  fs::path real = fs::weakly_canonical(path, error);
  return error ? path.lexically_normal() : real;
}

Chain read_chain(const fs::path& file, const fs::path& pipeline, const Overlay::Texts& texts,
                 Diagnostics& diagnostics) {
  Chain chain;
  std::vector<fs::path> open;
  if (!follow(file.lexically_normal(), pipeline, {file.string(), 0, 0}, texts, open, chain,
              diagnostics))
    chain.links.clear();
  return chain;
}

}  // namespace plumb::pipeline
