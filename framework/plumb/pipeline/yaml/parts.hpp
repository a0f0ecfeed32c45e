#pragma once
/// Names that are made of names: "coarse.kept.clusters".

#include <string>
#include <vector>

namespace plumb::pipeline {

/// The pieces of `text` between each `between`; one empty piece for an empty text.
std::vector<std::string> parts_of(const std::string& text, char between = '.');

}  // namespace plumb::pipeline
