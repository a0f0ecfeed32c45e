#pragma once
/// FLANN with random numbers that can be repeated. Its indices draw by the functions of
/// <flann/util/random.h>, from the process's one std::rand: what one thread gets depends on what
/// all others draw. Here these functions draw from a generator of each thread's own. So that a
/// FLANN that something else brings into the process is not taken for this one, all of it stands in
/// the namespace repeatable_flann. To be included instead of FLANN's headers, in .cpp files.
///
/// Not repeatable all the same, and not to be used: what asks std::random_device (the randomized
/// kd-trees, LSH), and the autotuned index, which measures times.

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <numeric>
#include <vector>

#include "plumb/data/random.hpp"

#ifdef FLANN_RANDOM_H
#error "FLANN's own random.h was included before"
#endif
#define FLANN_RANDOM_H
#define flann repeatable_flann

namespace flann {

inline plumb::Random& random_of_thread() {
  thread_local plumb::Random random(0);
  return random;
}

/// What follows in this thread is drawn anew from `seed`.
inline void seed_random(std::uint64_t seed) { random_of_thread() = plumb::Random(seed); }

inline double rand_double(double high = 1, double low = 0) {
  return low + (high - low) * random_of_thread().uniform();
}

inline int rand_int(int high = RAND_MAX, int low = 0) {
  return low + static_cast<int>(static_cast<double>(high - low) * random_of_thread().uniform());
}

/// 0 .. n-1, each once, in an order that is drawn; then -1.
class UniqueRandom {
 public:
  explicit UniqueRandom(int n) { init(n); }
  void init(int n) {
    left_.resize(static_cast<std::size_t>(n));
    std::iota(left_.begin(), left_.end(), 0);
  }
  int next() {
    if (left_.empty()) return -1;
    std::swap(left_[random_of_thread().below(static_cast<std::uint32_t>(left_.size()))],
              left_.back());
    const int drawn = left_.back();
    left_.pop_back();
    return drawn;
  }

 private:
  std::vector<int> left_;
};

}  // namespace flann

#include <flann/flann.hpp>

#undef flann
