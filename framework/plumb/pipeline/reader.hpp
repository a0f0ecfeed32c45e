#pragma once
/// YAML -> checked pipeline. Every mistake is found here, before any data is read, and all of them
/// are told at once.

#include <filesystem>
#include <string>
#include <vector>

#include "plumb/pipeline/bind/plan.hpp"
#include "plumb/pipeline/check/given_paths.hpp"
#include "plumb/pipeline/yaml/diagnostics.hpp"
#include "plumb/pipeline/yaml/former_names.hpp"
#include "plumb/pipeline/yaml/overlay.hpp"
#include "plumb/plugin/registry.hpp"

namespace plumb {

/// Reads and checks a pipeline, or a preset that extends one. Throws PipelineError with every
/// mistake that it finds. What is written by the `former` names is no mistake: Plan::renamings.
Plan read_pipeline(const std::filesystem::path& file, const Overlay& overlay,
                   const Registry& registry, const FormerNames& former = shipped_former_names());

/// The same as read_pipeline of a text that stands for itself: a plan's `resolved`. `name` is what
/// places are said to be in. Paths must be absolute, and lead somewhere.
Plan read_resolved(const std::string& text, const std::string& name, const Registry& registry,
                   const FormerNames& former = shipped_former_names());

}  // namespace plumb
