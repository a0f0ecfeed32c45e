#pragma once
/// Names that an earlier release used: data, of which the framework knows no entry.

#include <map>
#include <string>

namespace plumb {

/// The former name of each thing, and what it is called now. Steps and parameters that others are
/// listed under go by their names of now.
struct FormerNames {
  using Names = std::map<std::string, std::string, std::less<>>;
  using OfSteps = std::map<std::string, Names, std::less<>>;

  Names steps;
  OfSteps inputs, outputs, parameters;
  std::map<std::string, OfSteps, std::less<>> choices;  ///< by step and parameter
  OfSteps defaults;   ///< by step: parameter, and its former default where that was another value
  OfSteps pipelines;  ///< by the pipeline's name: its parameters, its rows as "coarse.gate"
};

/// Reads such a table (YAML). Throws PipelineError.
FormerNames read_former_names(const std::string& text, const std::string& file);

/// The table of this release, plugins/former_names.yaml when libplumb was built.
const FormerNames& shipped_former_names();

}  // namespace plumb
