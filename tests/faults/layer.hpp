#pragma once
/// How a call of the C library passes the layer: counted, made unless it is to fail, and logged
/// (watch.hpp, journal.hpp). Who includes this undefines _FORTIFY_SOURCE first, under which headers
/// of the C library define some of the functions themselves.
///
/// LD_PRELOAD puts the functions of layer_*.cpp before the real ones. fsync and its like are
/// counted, and nothing more: what a power cut would leave is worked out from the log (power.py),
/// and the disk has its peace. What the C library calls inside of itself does not come by here
/// (fwrite, dlopen); audit.py holds what strace sees against the log.

#include <dlfcn.h>

#include <cerrno>
#include <type_traits>

#include "journal.hpp"
#include "watch.hpp"

#define PASSED extern "C" __attribute__((visibility("default")))
/// The function of that name behind this library.
#define REAL(name) faults::real<decltype(&::name)>(#name)

namespace faults {

template <class Function>
Function real(const char* name) {
  return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

enum class Failing { instead, behind };  ///< what fails is not done, or done nevertheless: a close

/// Counts a call, makes it unless it is to fail, and logs it.
template <class Result, class Action>
Result made(const Call& call, Result bad, Action action, Failing failing = Failing::instead) {
  const Fate fate = fate_of(call);
  Result result = bad;
  if (!fate.fails() || failing == Failing::behind) result = action(fate);
  int error = errno;
  if (fate.fails()) result = bad, error = fate.error;
  long told = 0;
  if constexpr (std::is_pointer_v<Result>)
    told = result == bad ? -1 : 0;
  else
    told = static_cast<long>(result);
  log(call, fate, told, error);
  errno = error;
  return result;
}

template <class Action>
int on_path(const char* name, Kind kind, int at, const char* path, Action action, int flags = 0) {
  const std::string place = absolute(at, path);
  if (!is_watched(place)) return action();
  return made(Call{name, kind, -1, place, {}, 0, flags}, -1, [&](const Fate&) { return action(); });
}

template <class Action>
int on_two(const char* name, int at, const char* path, int second_at, const char* second,
           Action action, int flags = 0) {
  const std::string from = absolute(at, path), to = absolute(second_at, second);
  if (!is_watched(from) && !is_watched(to)) return action();
  return made(Call{name, Kind::room, -1, from, to, 0, flags}, -1,
              [&](const Fate&) { return action(); });
}

template <class Result, class Action>
Result on_fd(const char* name, Kind kind, int fd, Result bad, Action action,
             std::int64_t offset = 0, std::string_view bytes = {}, int flags = 0) {
  return made(Call{name, kind, fd, path_of(fd), {}, offset, flags, bytes}, bad, action);
}

}  // namespace faults
