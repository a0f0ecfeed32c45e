#pragma once
/// What a stage finds out beside the values that it gives.

#include <functional>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "plumb/pipeline/yaml/renamer.hpp"
#include "plumb/pipeline/yaml/tree.hpp"

namespace plumb::pipeline {

/// What is referred to, rightly or not, so that one mistake does not cause another.
struct Uses {
  using InRepeat = std::pair<int, int>;  ///< a repeat, and one of its rows or carries
  std::set<std::string, std::less<>> settings = {};
  std::set<InRepeat> rows = {}, carries = {};
  std::set<int> steps = {};
  bool dangling = false;  ///< something leads nowhere: what it meant only looks unused
};

/// Nodes of the tree as it was loaded that say something in former words, and what they say by the
/// names of now.
using NamesOfNow = std::map<const Node*, std::string>;

/// A stage at work: where it tells what it notices, and what it notes for its result. It does not
/// outlive the stage.
struct Reading {
  Renamer& names;
  Diagnostics& diagnostics;
  Uses uses = {};
  NamesOfNow now = {};

  void fault(const Origin& origin, std::string sentence, std::string hint = "") {
    diagnostics.add(origin, std::move(sentence), std::move(hint));
  }
  /// Notes that a node is read as `said` (yaml/renamer.hpp).
  void rename(const Node& node, const std::string& said);
  /// What a node says by the names of now.
  const std::string& text_of_now(const Node& node) const;
};

}  // namespace plumb::pipeline
