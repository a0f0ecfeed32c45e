#pragma once
/// Where the calls of a step are made: in this process (local_executor.hpp) or in others
/// (engine/remote).

#include <functional>
#include <string>
#include <vector>

#include "plumb/data/archive.hpp"

namespace plumb {

class StepRun;

/// What a call needs is not as it should be; the call itself is not to blame.
class MachineryError : public Error {
 public:
  using Error::Error;
};

struct Counted {
  std::string what;
  std::uint64_t n = 0;
};
/// What a step counted whose frames passed through the call.
struct PassedCounts {
  std::uint64_t run = 0, output = 0,
                item = 0;  ///< which run of the call's image, and what of it was asked for
  std::vector<Counted> counts;
};
struct Spent {
  std::string path;
  double cpu_seconds = 0;
};

/// What became of one call in another process.
struct Reply {
  std::uint64_t item = 0;
  std::string fault;  ///< a sentence that names step and item; empty when the call went well: then
                      ///< its result is in the store
  bool crashed = false;    ///< the process did not survive the call
  bool outside = false;    ///< it was killed from outside: the call need not be to blame
  bool machinery = false;  ///< not the call failed but what it needs: the store, the worker's
                           ///< modules, the input's state
  std::vector<Counted> counts;
  std::vector<PassedCounts> passed;
  std::vector<std::string> warnings;  ///< each begins with the step's path
  std::vector<Spent> spent;
  std::string
      result;  ///< a blob: what is never stored (the plain outputs of a step that has lazy ones)
  std::vector<std::vector<Hash128>> lazy;  ///< by output: the keys of what it makes when asked
  std::uint64_t process = 0;
  double seconds = 0;  ///< wall clock
};

/// Makes calls of steps. Safe from several threads.
class Executor {
 public:
  /// What became of a call: `fault` is a sentence that names step and item, empty when the call
  /// went well and the step has its result.
  using Done = std::function<void(std::size_t call, const std::string& fault)>;
  virtual ~Executor() = default;
  /// Makes the given calls of `run`, in any order, and tells of each; `done` is called from one
  /// thread at a time. A call of a step on whole collections is number 0. Once `run.stopped()`,
  /// calls that have not begun are left out, and nothing is told of them. Throws Error when
  /// something is wrong that is not the call's fault.
  virtual void make(StepRun& run, const std::vector<std::size_t>& calls, const Done& done) = 0;
  /// Whether calls are made in other processes, which find what they need in the store and leave
  /// there what they made.
  virtual bool elsewhere() const = 0;
};

template <class Archive, class T>
requires std::is_same_v<std::remove_const_t<T>, Counted>
void fields(Archive& a, T& c) { a(c.what, c.n); }
template <class Archive, class T>
requires std::is_same_v<std::remove_const_t<T>, PassedCounts>
void fields(Archive& a, T& c) { a(c.run, c.output, c.item, c.counts); }
template <class Archive, class T>
requires std::is_same_v<std::remove_const_t<T>, Spent>
void fields(Archive& a, T& s) { a(s.path, s.cpu_seconds); }
template <class Archive, class T>
requires std::is_same_v<std::remove_const_t<T>, Reply>
void fields(Archive& a, T& r) {
  a(r.item, r.fault, r.crashed, r.outside, r.machinery, r.counts, r.passed, r.warnings, r.spent,
    r.result, r.lazy, r.process, r.seconds);
}

}  // namespace plumb
