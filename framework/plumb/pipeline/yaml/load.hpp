#pragma once
/// Presets and `--set`: edits of the pipeline's tree, made before anything in it is read.

#include <set>

#include "plumb/pipeline/yaml/overlay.hpp"
#include "plumb/pipeline/yaml/renamer.hpp"
#include "plumb/pipeline/yaml/tree.hpp"

namespace plumb::pipeline {

/// A file and what it extends, the pipeline first.
struct Chain {
  struct Link {
    std::filesystem::path canonical;
    std::string file;  ///< as shown
    Node tree;
  };
  std::vector<Link> links;
};

/// A path with its links followed; as it is written where they lead round in a circle.
std::filesystem::path followed(const std::filesystem::path& path);

/// Reads `file` and, if it extends another, that one too; a preset is to lie over `pipeline`,
/// beside which one of nearly its name is looked for. `texts` are read instead of the files of
/// those names. Empty when one cannot be read; the diagnostic is written.
Chain read_chain(const std::filesystem::path& file, const std::filesystem::path& pipeline,
                 const Overlay::Texts& texts, Diagnostics& diagnostics);

/// The pipeline as one tree.
struct Loaded {
  Node tree;
  std::vector<std::string> files;  ///< that were read, the pipeline first
  /// What some step referred to before the last overlay was applied: parameters ("voxel_size") and
  /// rows ("coarse.gate"). An overlay may leave one of them without a use.
  std::set<std::string> referenced;
};

/// `file`, what it lays over what it extends, then presets and sets, all by the names of now. Empty
/// when there is nothing to go on with; the diagnostic is written.
std::optional<Loaded> load_pipeline(const std::filesystem::path& file, const Overlay& overlay,
                                    Renamer& names, Diagnostics& diagnostics);

/// Applies `remove`, `replace`, `add` and `set` of an overlay's tree, in this order.
void apply_overlay(Node& pipeline, const Node& overlay, Renamer& names, Diagnostics& diagnostics);

/// Applies edits that stand for one pipeline in a larger file: under an overlay's 'also', for a
/// preset may serve more pipelines than the one it extends, or in an experiment.
void apply_also(Node& pipeline, const Node& edits, Renamer& names, Diagnostics& diagnostics);

/// Applies each "path=value" of the command line.
void apply_sets(Node& pipeline, const std::vector<std::string>& options, Renamer& names,
                Diagnostics& diagnostics);

}  // namespace plumb::pipeline
