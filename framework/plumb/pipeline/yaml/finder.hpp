#pragma once
/// Where a path leads in a pipeline's tree, and what is edited there.

#include "plumb/pipeline/yaml/tree.hpp"

namespace plumb::pipeline {

/// Follows paths through groups and repeats to a step; what does not lead anywhere is told at
/// `origin`.
class Finder {
 public:
  Finder(Node& pipeline, const Origin& origin, Diagnostics& diagnostics)
      : pipeline_(pipeline), origin_(origin), diagnostics_(diagnostics) {}

  /// The map of steps that holds the last name of `path`, which need not be there if `fresh`; null
  /// with a diagnostic.
  Node* scope(const std::string& path, bool fresh);

  /// Takes away a step, a group or a repeat; a parameter of the pipeline, a row of a repeat; or
  /// what a step is given for a parameter, which then has its default.
  void remove(const std::string& path);

  /// Puts a value at a parameter, a row or a step's parameter. Text of the command line is cut at
  /// commas for a row.
  void set(const std::string& path, Node value, bool cut);

 private:
  Node* lost(const std::string& path, const std::vector<std::string>& parts, std::size_t k,
             const std::vector<std::string>& known);
  void not_settable(const std::string& path);
  void set_parameter(const std::string& name, Node value);
  void set_row(Node& repeat, const std::string& path, const std::string& name, Node value,
               bool cut);
  void set_step(Node& step, const std::string& name, Node value);

  Node& pipeline_;
  Origin origin_;
  Diagnostics& diagnostics_;
};

}  // namespace plumb::pipeline
