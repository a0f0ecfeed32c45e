#pragma once
/// A command line that is wrong: what is said of it.

#include <string>

#include "plumb/data/error.hpp"

namespace CLI {
class App;
class Error;
}  // namespace CLI

namespace plumb::command {

/// What can be said of the command line alone, before any file is looked at: a value that is not
/// understood, options that do not go together, one that is missing. The program exits with
/// exit_wrong_command_line then, as it does for what CLI11 refuses.
class UsageError : public Error {
 public:
  using Error::Error;
};

/// What `read` gives, which reads the value of an option: its Error is one of the command line.
template <class Read>
auto usage(const Read& read) {
  try {
    return read();
  } catch (const Error& e) {
    throw UsageError(e.what());
  }
}

/// One sentence for what CLI11 refused of `program`'s command line: the first word that nothing
/// takes, with the command or option that was probably meant; or else what `error` says.
std::string usage_sentence(const CLI::App& program, const CLI::Error& error);

}  // namespace plumb::command
