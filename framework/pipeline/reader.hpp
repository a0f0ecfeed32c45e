#pragma once
/// YAML -> checked pipeline. Every mistake is found here, before any data is read, and all of them
/// are told at once.

#include <filesystem>
#include <string>
#include <vector>

#include "plumb/pipeline/diagnostics.hpp"
#include "plumb/pipeline/plan.hpp"
#include "plumb/plugin/registry.hpp"

namespace plumb {

/// What is laid over a pipeline, in this order.
struct Overlay {
  std::vector<std::filesystem::path>
      presets;  ///< each extends the pipeline, or what was laid over it
  std::vector<std::string>
      sets;           ///< "voxel=0.2m", a row "coarse.gate=2m,1m", "coarse.kept.clusters=4"
  bool open = false;  ///< parameters without a value are no mistake (graph, resolve): steps see an
                      ///< empty value
  bool needs_files = false;  ///< a path that leads nowhere is a mistake (check, run)
  bool untrusted = false;    ///< a path that a file names is a mistake unless it lies in one that `sets` name
};

/// Reads and checks a pipeline, or a preset that extends one. Throws PipelineError with every
/// mistake that it finds.
Plan read_pipeline(const std::filesystem::path& file, const Overlay& overlay,
                   const Registry& registry);

/// The values of path parameters that come from the command line: what a stranger's pipeline may read.
std::vector<std::filesystem::path> given_paths(const Plan& plan);

/// The same of a text that stands for itself: a plan's `resolved`. `name` is what places are said to be in. Paths must be absolute, and lead somewhere.
Plan read_resolved(const std::string& text, const std::string& name, const Registry& registry);

}  // namespace plumb
