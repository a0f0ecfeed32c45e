#pragma once
/// Presets and `--set`, as the command line gives them.

#include <filesystem>
#include <map>
#include <string>
#include <vector>

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
  bool untrusted =
      false;  ///< a path that a file names is a mistake unless it lies in one that `sets` name
  using Texts = std::map<std::filesystem::path, std::string>;
  Texts texts = {};  ///< what is read instead of the files of those names (migrate)
};

}  // namespace plumb
