#pragma once
/// All that the results of a run depend on, and what it wrote: run.lock.yaml.

#include <filesystem>
#include <string>
#include <vector>

#include "plumb/engine/record/input_record.hpp"
#include "plumb/plugin/registry.hpp"

namespace plumb {

/// Name of the file that tells a folder of ours from any other; it lists the files that belong to
/// the run.
inline constexpr const char* lock_name = "run.lock.yaml";

/// A file that a run wrote, and what stood in it then.
struct FileRecord {
  std::string name;
  std::uint64_t bytes = 0;
  Hash128 hash;
  auto operator<=>(const FileRecord&) const = default;
};

struct StepRecord {
  std::string path, use;  ///< "coarse.matches", "match.nearest"
  int version = 0;        ///< 0: there is no such step
  std::string module;     ///< hash of the module's file; empty for a step of this process
  auto operator<=>(const StepRecord&) const = default;
};

/// No option of a run but the pipeline changes its results: threads, store and memory do not.
struct RunRecord {
  std::string plumb, abi, library;  ///< version; what a module must fit; hash of libplumb's file
  std::string name;                 ///< of the pipeline
  std::vector<FileRecord> files;    ///< written
  std::vector<StepRecord> steps;
  std::vector<InputRecord> inputs;
  std::string pipeline;  ///< Plan::resolved
};

/// Before the run; with `content`, of the inputs' bytes too. Throws Error: a module or input cannot
/// be read.
RunRecord record_of(const Plan& plan, bool content);

/// Whether its steps and inputs are those of the plan.
bool describes(const RunRecord& record, const Plan& plan);

/// The file's text. The same run gives the same text.
std::string lock_text(const RunRecord& record);

/// Reads it back. Throws Error: it is no record of a run, it is damaged, or an earlier Plumb wrote
/// it.
RunRecord read_lock(const std::filesystem::path& file);

/// The files that a run wrote beside the record of this text; nothing when the text is not as the
/// run wrote it.
std::optional<std::vector<FileRecord>> files_of_lock(const std::string& text);

/// The same steps and inputs as they are now. An input's content is looked at when `then` has it,
/// or `content` asks for it.
RunRecord record_now(const RunRecord& then, const Registry& registry, bool content);

/// What became of the inputs since `record` was taken, as a clause of a sentence; empty while they
/// are as they were. An input's content is looked at when the record has it.
std::string changed_input(const RunRecord& record);

/// One sentence for each difference that may change results, with what was and what is.
std::vector<std::string> differences(const RunRecord& then, const RunRecord& now);

}  // namespace plumb
