#pragma once
/// What stands in a pipeline as an earlier release wrote it.

#include <string>

#include "plumb/pipeline/yaml/origin.hpp"

namespace plumb {

/// One place that was read by the table of former names (yaml/former_names.hpp).
struct Renaming {
  enum class Kind {
    text,      ///< `was` is written there and is read as `now`
    standard,  ///< the step there is not given its parameter `was`, and has the former default
               ///< `now`
  };
  Kind kind = Kind::text;
  Origin origin;
  std::string was, now;

  /// One line: "a.yaml:7:5: warning: 'leaf' is called 'voxel_size' now; ..." and what to do.
  std::string warning() const;
  /// One line: what `plumb migrate` did there.
  std::string done() const;
};

}  // namespace plumb
