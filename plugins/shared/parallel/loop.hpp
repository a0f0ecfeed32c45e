#pragma once
/// Loops whose bodies run in parallel, for kernels that do not know who runs them.

#include <cstddef>
#include <functional>

#include "plumb/plugin/context.hpp"

namespace plumb::parallel {

/// Calls body(k) for k = 0 .. n-1, in any order and on any threads, and waits.
using Loop = std::function<void(std::size_t n, const std::function<void(std::size_t k)>& body)>;

/// The loop of the engine that runs a step; `context` must outlive it.
inline Loop on(Context& context) {
  return [&context](std::size_t n, const std::function<void(std::size_t)>& body) {
    context.parallel(n, body);
  };
}

}  // namespace plumb::parallel
