#include "plumb/pipeline/yaml/foreign_file.hpp"

#include <algorithm>

#include "plumb/data/error.hpp"
#include "plumb/data/io/file_kind.hpp"
#include "plumb/data/io/file_text.hpp"

namespace plumb::pipeline {
namespace fs = std::filesystem;
namespace {

/// The YAML files of a folder, by name; none when it cannot be read.
std::vector<fs::path> yaml_files(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (fs::directory_iterator at(folder.empty() ? fs::path(".") : folder, error), end;
       !error && at != end; at.increment(error))
    if (at->path().extension() == ".yaml" || at->path().extension() == ".yml")
      files.push_back((folder / at->path().filename()).lexically_normal());
  std::sort(files.begin(), files.end());
  return files;
}

std::string stem_of(const fs::path& file) {
  const auto extension = file.extension();
  return (extension == ".yaml" || extension == ".yml" ? file.stem() : file.filename()).string();
}

/// What stands at the beginning of a line before its key: a byte-order mark, a bracket, quotes.
std::string_view without_marks(std::string_view line) {
  if (line.starts_with("\xEF\xBB\xBF")) line.remove_prefix(3);
  line.remove_prefix(std::min(line.find_first_not_of("{\"' "), line.size()));
  return line;
}

bool begins_with(std::string_view line, const std::string& key) {
  if (!line.starts_with(key)) return false;
  line.remove_prefix(key.size());
  line.remove_prefix(std::min(line.find_first_not_of("\"' \t"), line.size()));
  return line.starts_with(':');
}

}  // namespace

bool has_key(std::string_view text, const std::vector<std::string>& keys) {
  bool blank = true;
  io::Lines lines(text);
  for (std::string_view line; lines.next(line);) {
    if (!line.starts_with(' '))
      for (const std::string& key : keys)
        if (begins_with(without_marks(line), key)) return true;
    const auto first = line.find_first_not_of(" \t");
    blank = blank && (first == line.npos || line[first] == '#');
  }
  return blank;
}

bool is_experiment(std::string_view text) {
  if (has_key(text, {})) return false;  // blank
  const auto has = [&](const char* key) { return has_key(text, {key}); };
  return has("experiment") ||
         (has("pipeline") && has("primary") && !has("steps") && !has("extends"));
}

std::optional<Fault> foreign_file(const fs::path& file, std::string_view text) {
  const std::string name = "'" + file.string() + "' is ";
  if (text.starts_with(lock_first_line))
    return Fault{name + "the record of a run, not a pipeline.",
                 "Give the pipeline that was run; or repeat the run itself: plumb run --locked " +
                     file.string() + " -o DIR."};
  const std::string kind = io::kind_of_content(text);
  if ((kind.empty() || kind == "a pipeline") && is_experiment(text))
    return Fault{name + "an experiment, not a pipeline.",
                 "Run it: plumb compare " + file.string() + "."};
  if (kind.empty() || kind == "a pipeline") {
    if (has_key(text, {"plumb", "steps", "extends", "also", "set", "add", "replace", "remove"}))
      return std::nullopt;
    return Fault{name + "no pipeline: no line of it begins with 'plumb:', 'steps:' or 'extends:'.",
                 "Give the YAML file of a pipeline."};
  }
  if (kind == "a JSON Schema")
    return Fault{name + "a JSON Schema, not a pipeline.",
                 "It is for editors; give the YAML file of a pipeline."};
  return Fault{
      name + kind + ", not a pipeline.",
      "Give the YAML file of a pipeline; its data goes behind --set, as in --set input=DIR."};
}

namespace {

/// As far as a first look tells: a sequence has its scene in YAML too, results their record.
bool may_be_a_pipeline(const fs::path& file) try {
  constexpr std::uint64_t largest = 1 << 20;
  return !foreign_file(file, io::FileBytes(file, largest, "pipeline").view());
} catch (const Error&) {
  return false;  // no file, or one that cannot be read
}

std::vector<std::string> pipelines_in(const fs::path& folder) {
  constexpr std::size_t most = 100;  // that are looked into
  std::vector<std::string> names;
  std::vector<fs::path> files = yaml_files(folder);
  files.resize(std::min(files.size(), most));
  for (const fs::path& file : files)
    if (may_be_a_pipeline(file)) names.push_back(file.string());
  return names;
}

}  // namespace

Fault foreign_folder(const fs::path& folder) {
  const std::vector<std::string> names = pipelines_in(folder);
  constexpr std::size_t readable = 8;
  return {"'" + folder.string() + "' is a folder, not a pipeline.",
          names.empty() || names.size() > readable
              ? "Give the YAML file of a pipeline; its data goes behind --set, as in --set input=" +
                    folder.string() + "."
              : "In it: " + joined(names) + "."};
}

std::string cure_for_missing(const fs::path& file, const fs::path& pipeline) {
  std::vector<fs::path> folders = {file.parent_path()};
  if (pipeline.empty())
    folders.insert(folders.end(), {"pipelines", "pipelines/presets"});
  else
    folders.insert(folders.end(), {pipeline.parent_path(), pipeline.parent_path() / "presets"});
  std::vector<fs::path> found;
  std::vector<std::string> stems;
  for (const fs::path& folder : folders)
    for (const fs::path& candidate : yaml_files(folder)) {
      found.push_back(candidate);
      stems.push_back(stem_of(candidate));
    }
  const std::string near = nearest(stem_of(file), stems);
  const auto at = std::find(stems.begin(), stems.end(), near);
  return at == stems.end() ? "" : "Did you mean '" + found[at - stems.begin()].string() + "'?";
}

}  // namespace plumb::pipeline
