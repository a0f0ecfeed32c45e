#pragma once
/// For tests that a result does not depend on how loops run: in order, backwards, on several
/// threads; as loops, and as contexts of a step.

#include <cstddef>
#include <functional>
#include <thread>
#include <vector>

#include "plumb/plugin/testing.hpp"
#include "plumb/slam/step.hpp"

namespace plumb::parallel {

inline void in_order(std::size_t n, const std::function<void(std::size_t)>& body) {
  for (std::size_t k = 0; k < n; ++k) body(k);
}
inline void backwards(std::size_t n, const std::function<void(std::size_t)>& body) {
  while (n > 0) body(--n);
}
/// Four threads, each from the last to the first.
inline void on_threads(std::size_t n, const std::function<void(std::size_t)>& body) {
  std::vector<std::jthread> threads;
  for (std::size_t t = 0; t < 4; ++t)
    threads.emplace_back([&body, n, t] {
      for (std::size_t k = n; k-- > 0;)
        if (k % 4 == t) body(k);
    });
}

struct BackwardsContext : TestContext {
  void parallel(std::size_t n, const std::function<void(std::size_t)>& body) override {
    backwards(n, body);
  }
};
struct ThreadedContext : TestContext {
  void parallel(std::size_t n, const std::function<void(std::size_t)>& body) override {
    on_threads(n, body);
  }
};

}  // namespace plumb::parallel
