#pragma once
/// What a step says in former words, found when it is read: choices, and the rows and parameters of
/// our own pipelines.

#include <string>

#include "plumb/pipeline/bind/declared.hpp"

namespace plumb::pipeline {

/// The parameter of the pipeline that "$name" at `node` means, by its name of now.
std::string setting_of_now(Reading& reading, const Settings& settings, const Node& node,
                           const std::string& name);
/// The same where it may mean a row of the repeats from `repeat` outwards.
std::string row_or_setting_of_now(Reading& reading, const Declared& declared, const Node& node,
                                  const std::string& name, int repeat);

/// Notes which choices `node`, given to a step for `parameter`, writes by former names; also those
/// in the row or parameter of the pipeline that it refers to.
void note_choices(Reading& reading, const Declared& declared, int step,
                  const ParameterDescription& parameter, const Node& node);

/// `tree` with what was noted of its nodes.
Node tree_of_now(const Node& tree, const NamesOfNow& now);

}  // namespace plumb::pipeline
