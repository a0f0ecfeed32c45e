#pragma once
/// `--untrusted`: a stranger's pipeline reads only what the command line gives it, uses shipped
/// modules only, and has bounds of memory and time.

#include <filesystem>
#include <string>
#include <vector>

#include "pipeline_options.hpp"

namespace plumb::command {

class Untrusted {
 public:
  void add_to(Command& command);
  explicit operator bool() const { return on_; }

  /// Before the pipeline is read: bounds, and a fence round the folders of the pipeline and presets
  /// that were named, and of the modules. Nothing without the flag. Throws UsageError: bounds that
  /// are none, --plugin-path.
  void before_reading(PipelineOptions& pipeline) const;
  /// The steps of this installation; also of --plugin-path and PLUMB_PLUGIN_PATH without the flag.
  Registry steps() const;
  /// Before data are read: the fence round what --set gives the plan, and `own`: the folders of the
  /// output and the store.
  void before_running(const Plan& plan, const Registry& steps,
                      std::vector<std::filesystem::path> own) const;

 private:
  bool on_ = false;
  std::string memory_ = "4GiB", time_ = "1h";
};

}  // namespace plumb::command
