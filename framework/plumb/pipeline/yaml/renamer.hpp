#pragma once
/// Reads what an earlier release wrote as it is written now, and remembers where.

#include <optional>

#include "plumb/pipeline/yaml/former_names.hpp"
#include "plumb/pipeline/yaml/renaming.hpp"
#include "plumb/pipeline/yaml/tree.hpp"
#include "plumb/plugin/registry.hpp"

namespace plumb::pipeline {

/// A name is replaced only where the step does not declare the former one (a module from elsewhere
/// may), and does declare the one of now.
class Renamer {
 public:
  Renamer(const FormerNames& table, const Registry& registry, Diagnostics& diagnostics)
      : table_(table), registry_(registry), diagnostics_(diagnostics) {}

  /// Brings the steps of a pipeline, just read, to the names of now; a file that had former names
  /// also has the former defaults. The pipeline's name says by which table what is laid over it is
  /// read.
  void read_pipeline(Node& tree);
  /// The same of the steps that an overlay replaces and adds, also under its 'also'.
  void read_overlay(Node& tree);

  /// A path of 'set', 'remove' and --set by the names of now, before it is followed in `pipeline`.
  std::string path(const Node& pipeline, const std::string& written, const Origin& origin);

  /// What is called so now; nothing for what is no former name. Nobody notes it yet.
  std::optional<std::string> output(const StepDescription& step, const std::string& name) const;
  std::optional<std::string> choice(const StepDescription& step,
                                    const ParameterDescription& parameter,
                                    const std::string& name) const;
  /// A parameter ("leaf") or row ("coarse.gate") of the pipeline that was read.
  std::optional<std::string> setting(const std::string& name) const;

  void note(const Origin& origin, const std::string& was, const std::string& now);
  /// In the order of the files and lines.
  std::vector<Renaming> noted() const;

 private:
  template <class Do>
  void for_each_step(Node& steps, const Do& act);
  void read_steps(const std::vector<Node*>& maps);
  void rename(Node& step);
  template <class Declares>
  void rename_keys(Node& map, const FormerNames::Names* names, const Declares& declares);
  void restore_defaults(Entry& step);
  std::string parameter_path(const Node& pipeline, const std::string& path) const;

  const FormerNames& table_;
  const Registry& registry_;
  Diagnostics& diagnostics_;
  std::string pipeline_;  ///< name
  std::vector<Renaming> noted_;
};

/// For two names of one thing that are given side by side.
void refuse_both(const Origin& origin, const std::string& was, const std::string& now,
                 const Origin& other, Diagnostics& diagnostics);

}  // namespace plumb::pipeline
