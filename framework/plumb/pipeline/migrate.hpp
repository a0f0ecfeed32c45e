#pragma once
/// A pipeline of an earlier release, written by the names of now.

#include <filesystem>
#include <string>
#include <vector>

#include "plumb/pipeline/reader.hpp"

namespace plumb {

struct Migrated {
  std::string text;            ///< of the file, rewritten
  std::vector<Renaming> done;  ///< none: nothing had to be
};

/// What the file of a pipeline or preset says, with the names of now and the former defaults that
/// it was read with; all else stays as it is written. A preset is read over what it extends and
/// each pipeline that it names under 'also'. Throws PipelineError: mistakes; a place that cannot be
/// edited; a result that would not be the same pipeline.
Migrated migrated(const std::filesystem::path& file, const Registry& registry,
                  const FormerNames& former = shipped_former_names());

}  // namespace plumb
