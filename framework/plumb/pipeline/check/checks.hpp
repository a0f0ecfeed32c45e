#pragma once
/// What is judged of a pipeline whose names are bound; each check is a file.

#include "plumb/pipeline/bind/draft.hpp"

namespace plumb::pipeline {

void find_order(Draft& draft);    ///< or the cycle
void find_domains(Draft& draft);  ///< which items a step has
void find_unused(Draft& draft);
void find_missing_files(Draft& draft);  ///< paths that lead nowhere
void find_foreign_paths(Draft& draft);  ///< the same, and paths that the command line did not give:
                                        ///< they are not looked at

}  // namespace plumb::pipeline
