#pragma once
/// How a step, a reader or the framework refuses: one sentence that says what, where, and the cure.

#include <stdexcept>
#include <string>

namespace plumb {

/// A wrong input. `what()` is one sentence for the user, with the place (file, line, step) and the
/// cure.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace plumb
