#pragma once
/// A module's manifest: what its steps declare, as JSON beside the module, so that listing and
/// checking run no foreign code.

#include <string>
#include <vector>

#include "plumb/plugin/description.hpp"

namespace plumb {

struct Manifest {
  std::string abi_tag;
  std::vector<StepDescription> steps;
};

/// The manifest's text: JSON, one step after another, keys in a fixed order.
std::string manifest_text(const Manifest& manifest);

/// Reads it back. Throws Error that says what is wrong; `file` names it in the sentence.
Manifest read_manifest(const std::string& text, const std::string& file);

/// One step as JSON text, for `plumb inspect --json`.
std::string step_json(const StepDescription& step);

}  // namespace plumb
