#pragma once
/// What is compared: variants of a pipeline, on inputs, in replicates.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "plumb/pipeline/yaml/overlay.hpp"

namespace plumb::experiment {

/// The pipeline with something changed in it, or another pipeline.
struct Variant {
  std::string name;                     ///< of a folder, too (data/file_name.hpp)
  std::filesystem::path pipeline = {};  ///< one by itself; empty: that of the experiment
  std::vector<std::filesystem::path> presets = {};
  std::vector<Edits> edits = {};       ///< written in the experiment's file
  std::vector<std::string> sets = {};  ///< of the command line: "voxel_size=0.3m"
  /// What a sweep gave it: each parameter and its value, as written.
  std::vector<std::pair<std::string, std::string>> swept = {};

  /// Whether it is a pipeline by itself, which nothing that is said of the experiment's reaches.
  bool alone() const { return !pipeline.empty(); }
};

/// Makes of a file what it is: one that extends nothing is a pipeline by itself, any other a preset
/// that is laid over `pipeline`. One that cannot be read counts as a preset, and is told later.
void take_file(Variant& variant, const std::filesystem::path& file,
               const std::filesystem::path& pipeline);

/// A log, or the folder of a sequence.
struct Input {
  std::string name;
  std::filesystem::path path;
  std::vector<Edits> edits = {};  ///< parameters of its own
  std::string where;              ///< that says so: "--input street", "a.yaml:7:5: input 'street'"
};

/// A name for each path, of which no two are the same: what it ends with.
std::vector<std::string> names_of(const std::vector<std::filesystem::path>& paths);

/// The same runs again with what is arbitrary in them disturbed, alike for all variants. The first
/// replicate is undisturbed.
struct Replicates {
  std::size_t count = 1;
  std::uint64_t seed = 0;
  std::uint32_t skip_frames = 0;  ///< up to so many frames are left out at the beginning
  double drop_frames = 0;         ///< share of the frames that is left out
  bool phase = false;             ///< where segments are cut
  bool seeds = false;             ///< of steps that draw

  bool disturb_nothing() const { return skip_frames == 0 && drop_frames == 0 && !phase && !seeds; }
  /// What `count` alone means.
  void disturb_all() { skip_frames = 5, drop_frames = 0.01, phase = seeds = true; }
};

/// A parameter, row or step's parameter with the values that are tried.
struct Axis {
  std::string name;
  Origin origin;
  std::vector<pipeline::Node> values;                 ///< scalars, or lists for a row
  std::shared_ptr<const std::string> text = nullptr;  ///< of the file in which they stand
};

/// Which of the axes' values go together.
enum class SweepBy {
  grid,           ///< each with each
  paired,         ///< the first ones, the second ones, ...
  one_at_a_time,  ///< each by itself, the other axes as the pipeline has them
};

struct Experiment {
  std::string name, about;
  std::filesystem::path pipeline;      ///< or a preset that extends one: the first variant
  std::vector<Edits> edits = {};       ///< of all variants that are no pipelines by themselves
  std::vector<std::string> sets = {};  ///< the same, of the command line
  std::vector<Variant> variants = {};  ///< but the pipeline as it is and those of the sweep
  std::vector<Axis> axes = {};
  SweepBy sweep_by = SweepBy::grid;
  std::vector<Input> inputs = {};
  Replicates replicates = {};
  std::string primary;                    ///< the one number that decides, "error.fine.ate"
  double margin = 0.05;                   ///< up to which variants count as equivalent
  std::vector<std::string> metrics = {};  ///< globs of further numbers; none: the usual ones
  std::vector<std::string> higher_is_better = {};  ///< globs; of all others lower is
  std::vector<std::string> timed = {};             ///< how the `use` of the timed steps begins
  std::string timed_where = "--time";              ///< that says so: "a.yaml:7:7: 'time'"
};

/// Reads an experiment (YAML). Throws PipelineError with every mistake and its place.
Experiment read_experiment(const std::filesystem::path& file);

/// The variants that a sweep makes, named by what they set, as "voxel_size=0.2m,gate=[3m,1m]".
/// Throws Error: paired axes with other numbers of values, or more than 1,000 variants.
std::vector<Variant> swept_variants(const std::vector<Axis>& axes, SweepBy by);

/// "voxel_size=0.2m,0.3m", as the command line gives it; a row's value stands in brackets:
/// "coarse.gate=[3m,1m],[2m]". Throws Error.
Axis axis_of(const std::string& option);

}  // namespace plumb::experiment
