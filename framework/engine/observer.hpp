#pragma once
/// What a run tells while it goes: one stream of events that feeds progress, log and trace.

#include <cstdint>
#include <string>

namespace plumb {

/// Receives events; calls may come from several threads at once. The default does nothing.
class Observer {
 public:
  virtual ~Observer() = default;
  /// A step begins; `items` is 1 for a step on whole collections.
  virtual void step_begins(const std::string& /*path*/, std::size_t /*items*/) {}
  virtual void item_done(const std::string& /*path*/) {}
  virtual void step_ends(const std::string& /*path*/, double /*seconds*/) {}
  virtual void pass_begins(const std::string& /*repeat*/, int /*pass*/, int /*at_most*/) {}
  /// A sentence that is worth knowing; the run goes on.
  virtual void note(const std::string& /*sentence*/) {}
};

}  // namespace plumb
