#pragma once
/// Places in files, as every sentence about a pipeline gives them.

#include <string>

namespace plumb {

/// Where something was written. `file` may be a command-line option, as in "--set voxel=0.2m" (then
/// line is 0).
struct Origin {
  std::string file;
  int line = 0, column = 0;  ///< from 1
  std::string text() const;  ///< "pipelines/city.yaml:14:5"
};

}  // namespace plumb
