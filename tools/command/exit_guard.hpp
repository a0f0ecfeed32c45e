#pragma once
/// A module that ends the program.

namespace plumb::command {

/// While one lives, exit() and quick_exit(), which only a module can call then, do not end the
/// program as if all were well: what is staged is removed, the step is named, and the program ends
/// with 3. Make one before modules are loaded, and another when they are: what was registered last
/// is called first. _exit() runs nothing of ours and is like a kill.
class ExitGuard {
 public:
  ExitGuard();
  ~ExitGuard();
  ExitGuard(const ExitGuard&) = delete;
  ExitGuard& operator=(const ExitGuard&) = delete;
};

}  // namespace plumb::command
