#pragma once
/// What run, check, resolve and graph have in common: a pipeline with presets and settings.

#include <CLI/CLI.hpp>

#include "command.hpp"
#include "plumb/pipeline/reader.hpp"

namespace plumb::command {

/// What is wrong with NAME=VALUE behind --set, whatever the pipeline; "" for nothing.
std::string fault_of_set(const std::string& text);

struct PipelineOptions {
  std::filesystem::path file;
  Overlay overlay;

  void add_to(CLI::App& command) {
    command.add_option("PIPELINE", file, "A pipeline or a preset (YAML)")->required();
    command
        .add_option("--preset", overlay.presets,
                    "A preset to lay over the pipeline; may be given again")
        ->allow_extra_args(false);
    command
        .add_option("--set", overlay.sets,
                    "A parameter, a row or a step's parameter: input=DIR, voxel_size=0.2m, "
                    "coarse.kept.pairs_per_cluster=30; a '$' in it is written '$$'; may be given "
                    "again")
        ->allow_extra_args(false)
        ->check(fault_of_set);
  }
};

/// A line on standard error for each place that is written by names of an earlier release, and for
/// what is perhaps not meant.
void say_warnings(const Plan& plan);

}  // namespace plumb::command
