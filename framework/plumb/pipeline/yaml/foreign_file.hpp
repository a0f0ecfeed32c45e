#pragma once
/// Files that somebody took for a pipeline, and names that lead to none.

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "plumb/pipeline/yaml/value.hpp"

namespace plumb::pipeline {

/// The first line of every run.lock.yaml.
inline constexpr const char* lock_first_line =
    "# A run of Plumb: what made the files beside this one.";

/// Whether a line of `text` begins with one of `keys` and a colon, or all of it is blank: what
/// begins so is shown when it is wrong, and nothing of other files, which a pipeline from elsewhere
/// may name to have them printed.
bool has_key(std::string_view text, const std::vector<std::string>& keys);

/// Whether a text is that of an experiment (`plumb compare`), which names pipelines and is none;
/// also one that says 'plumb: 1' where 'experiment: 1' belongs.
bool is_experiment(std::string_view text);

/// What `file` is and what to give instead, when its text is plainly no pipeline's. Says nothing of
/// what is in it.
std::optional<Fault> foreign_file(const std::filesystem::path& file, std::string_view text);

/// The same for a folder.
Fault foreign_folder(const std::filesystem::path& folder);

/// Which pipeline or preset of about that name there is. A preset is also looked for beside
/// `pipeline` and in its presets/.
std::string cure_for_missing(const std::filesystem::path& file,
                             const std::filesystem::path& pipeline);

}  // namespace plumb::pipeline
