#pragma once
/// For tests of the stages between the text of a pipeline and its plan.

#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "plumb/pipeline/check/checks.hpp"
#include "plumb/pipeline/testing/former_testing.hpp"

namespace plumb::test {

/// A text as a.yaml, stage by stage; `former()` is the table of its former names.
class Stages {
 public:
  explicit Stages(const std::string& text) {
    auto tree = pipeline::parse_yaml(text, "a.yaml", diagnostics_);
    if (!tree) throw std::logic_error("a text that is no YAML");
    names_.read_pipeline(*tree);
    loaded_ = std::make_shared<const pipeline::Loaded>(
        pipeline::Loaded{std::move(*tree), {"a.yaml"}, {}});
  }
  Stages(const Stages&) = delete;
  Stages& operator=(const Stages&) = delete;

  const pipeline::Node& tree() const { return loaded_->tree; }
  pipeline::Declared declared() {
    return pipeline::declare(loaded_, false, registry(), names_, diagnostics_);
  }
  pipeline::Bound bound(const pipeline::Declared& declared) {
    return pipeline::bind(declared, names_, diagnostics_);
  }
  /// Of a pipeline that is also checked, but for its files.
  pipeline::Bound checked() {
    pipeline::Bound result = bound(declared());
    pipeline::check_unused(result, false, diagnostics_);
    pipeline::domains_of(result, pipeline::order_of(result, diagnostics_), diagnostics_);
    return result;
  }
  pipeline::Diagnostics& diagnostics() { return diagnostics_; }
  /// "a.yaml:13:19: step ..." of each mistake until now.
  std::vector<std::string> told() const {
    std::vector<std::string> all;
    try {
      diagnostics_.raise();
    } catch (const PipelineError& error) {
      for (const Diagnostic& d : error.diagnostics())
        all.push_back(d.origin.text() + ": " + d.sentence);
    }
    return all;
  }

 private:
  pipeline::Diagnostics diagnostics_;
  pipeline::Renamer names_{former(), registry(), diagnostics_};
  std::shared_ptr<const pipeline::Loaded> loaded_;
};

/// The cascade, which needs no --set, with each first word of `pairs` exchanged for the second.
inline std::string cascade_with(std::vector<std::pair<std::string, std::string>> pairs) {
  pairs.emplace_back("{type: path,", "{type: path, default: data,");
  return exchanged(cascade, pairs);
}

/// Which step of the cascade has this path.
inline std::size_t index_in(const pipeline::Declared& declared, const std::string& path) {
  for (std::size_t k = 0; k < declared.steps.size(); ++k)
    if (declared.steps[k].path == path) return k;
  throw std::logic_error("no step " + path);
}

}  // namespace plumb::test
