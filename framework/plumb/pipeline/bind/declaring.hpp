#pragma once
/// The parts of declare().

#include <string>
#include <string_view>
#include <vector>

#include "plumb/pipeline/bind/declared.hpp"

namespace plumb::pipeline {

/// The pipeline's parameters.
Settings settings_of(const Node& tree, bool open, Diagnostics& diagnostics);

/// Steps, groups and repeats by their names.
struct Outline {
  std::vector<Scope> scopes = {};
  std::vector<DeclaredStep> steps = {};
  std::vector<DeclaredRepeat> repeats = {};
};
Outline outline_of(const Node& tree, const Settings& settings, const Registry& registry,
                   Reading& reading);

/// Rows, carried values and counts of one repeat of the outline, those around which have theirs.
/// What is carried gets its name in the scope of the body.
Passes passes_of(Outline& outline, int repeat, const Settings& settings, Reading& reading);

/// Letters, digits and '_', a letter first.
bool valid_name(std::string_view name);
/// Adds a name to a scope. A name that an outer scope has too is refused: nobody could say which is
/// meant.
bool add_name(std::vector<Scope>& scopes, int scope, const std::string& name, const Symbol& symbol,
              Diagnostics& diagnostics);

}  // namespace plumb::pipeline
