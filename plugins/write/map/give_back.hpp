#pragma once
/// Hands memory that was freed back to the system, where the C library can be asked to.

#if __has_include(<malloc.h>)
#include <malloc.h>
#endif

namespace plumb::write_map {

/// Without this the many small pieces that a map frees would stay with the process while the file
/// that they become takes the same again.
inline void give_back() {
#if defined(__GLIBC__)
  malloc_trim(0);
#endif
}

}  // namespace plumb::write_map
