#pragma once
/// A module's manifest: what its steps declare and the licences it comes under, as JSON beside the
/// module, so that listing and checking run no foreign code.

#include <string>
#include <vector>

#include "plumb/plugin/description.hpp"
#include "plumb/plugin/licence.hpp"

namespace plumb {

struct Manifest {
  std::string abi_tag;
  std::vector<StepDescription> steps;
  Licence licence;  ///< not stated in manifests of earlier builds
};

/// The manifest's text: JSON, one step after another, keys in a fixed order.
std::string manifest_text(const Manifest& manifest);

/// Reads it back, and registers the kinds and types that it defines. Throws Error that says what is
/// wrong, and registers nothing then; `file` names it in the sentence.
Manifest read_manifest(const std::string& text, const std::string& file);

/// What a step declares, as JSON text.
std::string step_json(const StepDescription& step);

/// The same with the licences of its module, null where they are not stated, for `plumb inspect
/// --json`.
std::string step_json(const StepDescription& step, const Licence& licence);

}  // namespace plumb
