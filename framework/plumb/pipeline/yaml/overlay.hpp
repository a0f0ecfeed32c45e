#pragma once
/// Presets and `--set`, as the command line gives them.

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "plumb/pipeline/yaml/tree.hpp"

namespace plumb {

/// What a preset may hold (remove, replace, add, set), standing in a file of another kind: a
/// variant of an experiment.
struct Edits {
  pipeline::Node tree;
  std::shared_ptr<const std::string> text = nullptr;  ///< of that file, to show lines of it
};

/// What is laid over a pipeline: presets, edits, sets.
struct Overlay {
  std::vector<std::filesystem::path>
      presets;  ///< each extends the pipeline, or what was laid over it
  std::vector<std::string>
      sets;           ///< "voxel=0.2m", a row "coarse.gate=2m,1m", "coarse.kept.clusters=4"
  bool open = false;  ///< parameters without a value are no mistake (graph, resolve): steps see an
                      ///< empty value
  bool needs_files = false;  ///< a path that leads nowhere is a mistake (check, run)
  bool untrusted =
      false;  ///< a path that a file names is a mistake unless it lies in one that `sets` name
  using Texts = std::map<std::filesystem::path, std::string>;
  Texts texts = {};               ///< what is read instead of the files of those names (migrate)
  std::vector<Edits> edits = {};  ///< laid over behind the presets, before `sets`
};

}  // namespace plumb
