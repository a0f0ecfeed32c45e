#pragma once
/// What run, check, resolve and graph have in common: a pipeline with presets and settings.

#include <filesystem>
#include <string>

#include "command.hpp"
#include "plumb/pipeline/reader.hpp"

namespace plumb::command {

/// What is wrong with NAME=VALUE behind --set, whatever the pipeline; "" for nothing.
std::string fault_of_set(const std::string& text);

struct PipelineOptions {
  std::filesystem::path file;
  Overlay overlay;

  void add_to(Command& command);
};

/// A line on standard error for each place that is written by names of an earlier release, and for
/// what is perhaps not meant.
void say_warnings(const Plan& plan);

}  // namespace plumb::command
