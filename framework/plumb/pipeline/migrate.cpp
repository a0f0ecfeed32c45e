#include "plumb/pipeline/migrate.hpp"

#include <algorithm>

#include "plumb/data/io/file_text.hpp"
#include "plumb/pipeline/yaml/load.hpp"
#include "plumb/pipeline/yaml/rewritten.hpp"

namespace plumb {

using namespace pipeline;
namespace fs = std::filesystem;

namespace {

/// What a file is read as.
struct NamesRead {
  std::vector<Renaming> renamings;     ///< in the file itself
  std::vector<std::string> pipelines;  ///< that result, without comments
};

std::string without_comments(const std::string& text) {
  std::string bare;
  io::Lines lines(text);
  for (std::string_view line; lines.next(line);) {
    line = line.substr(0, line.find(" # "));
    bare += line.substr(0, line.find_last_not_of(' ') + 1);
    bare += '\n';
  }
  return bare;
}

/// The pipelines that a preset serves beside the one that it extends.
std::vector<fs::path> also_served(const fs::path& file, const Overlay::Texts& texts) {
  Diagnostics ignored;  // the file was read before
  const Chain chain = read_chain(file, {}, texts, ignored);
  const Node* also = chain.links.empty() ? nullptr : chain.links.back().tree.at("also");
  std::vector<fs::path> served;
  if (also)
    for (const std::string& name : also->keys())
      served.push_back((file.parent_path() / name).lexically_normal());
  return served;
}

NamesRead reading_of(const fs::path& file, const Overlay::Texts& texts, const Registry& registry,
                     const FormerNames& former) {
  NamesRead reading;
  Overlay overlay;
  overlay.open = true;
  overlay.texts = texts;
  const auto add = [&](const Plan& plan) {
    reading.pipelines.push_back(without_comments(plan.resolved));
    for (const Renaming& renaming : plan.renamings) {
      const bool known = std::any_of(
          reading.renamings.begin(), reading.renamings.end(), [&](const Renaming& other) {
            return other.was == renaming.was && other.origin.text() == renaming.origin.text();
          });
      if (!known && renaming.origin.file == file.string()) reading.renamings.push_back(renaming);
    }
  };
  add(read_pipeline(file, overlay, registry, former));
  overlay.presets = {file};
  for (const fs::path& pipeline : also_served(file, texts))
    add(read_pipeline(pipeline, overlay, registry, former));
  return reading;
}

}  // namespace

Migrated migrated(const fs::path& given, const Registry& registry, const FormerNames& former) {
  const fs::path file = given.lexically_normal();
  const NamesRead before = reading_of(file, {}, registry, former);
  Migrated result{std::string(io::FileBytes(file).view()), before.renamings};
  if (result.done.empty()) return result;
  Diagnostics diagnostics;
  diagnostics.read(file.string(), result.text);
  result.text = rewritten(result.text, file.string(), result.done, diagnostics);
  diagnostics.raise();
  // An anchor, say, may have brought a new name to where the old one was right.
  const auto refuse = [&](const std::string& why) {
    diagnostics.add({file.string(), 0, 0}, "cannot be rewritten place by place: " + why,
                    "Write the new names yourself; 'plumb check' warns of each old one.");
    diagnostics.raise();
  };
  NamesRead after;
  try {
    after = reading_of(file, {{file, result.text}}, registry, former);
  } catch (const PipelineError& error) {
    refuse("the result would have a mistake, " + error.diagnostics().front().sentence);
  }
  if (!after.renamings.empty()) refuse("'" + after.renamings.front().was + "' would be left.");
  if (after.pipelines != before.pipelines) refuse("the result would not be the same pipeline.");
  return result;
}

}  // namespace plumb
