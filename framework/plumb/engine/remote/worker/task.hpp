#pragma once
/// What a driver asks of workers, and how it is told: messages over a socket, the same bytes in
/// files for other machines.

#include <string>
#include <vector>

#include "plumb/engine/run/executor.hpp"

namespace plumb {

/// One call of a step, by its number, with the words that name it when its process cannot.
struct Call {
  std::uint64_t item = 0;
  Hash128 key;        ///< that its result will have in the store
  std::string title;  ///< "step 'matches' (match.nearest), edge 3-4"
};

/// Calls of one step run.
struct Task {
  std::string image;  ///< bytes of an Image
  std::vector<Call> calls;
  std::uint64_t threads = 1;  ///< that one call may use
};

/// To a worker: take this image, if there is one, and then make this call.
struct Request {
  std::string image;  ///< empty: as before
  std::uint64_t item = 0, threads = 1;
  Hash128 key;  ///< of the result, as the driver has it
};

template <class Archive, class T>
requires std::is_same_v<std::remove_const_t<T>, Call>
void fields(Archive& a, T& c) { a(c.item, c.key, c.title); }
template <class Archive, class T>
requires std::is_same_v<std::remove_const_t<T>, Task>
void fields(Archive& a, T& t) { a(t.image, t.calls, t.threads); }
template <class Archive, class T>
requires std::is_same_v<std::remove_const_t<T>, Request>
void fields(Archive& a, T& r) { a(r.image, r.item, r.threads, r.key); }

}  // namespace plumb
