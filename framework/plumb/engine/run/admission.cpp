#include "plumb/engine/run/admission.hpp"

#include <malloc.h>

#include <algorithm>

namespace plumb {

Admission::Ticket::Ticket(Admission& admission, std::size_t bytes)
    : admission_(admission), bytes_(std::min(bytes, admission.budget_)) {
  if (!admission_.bounded()) return;
  std::unique_lock lock(admission_.mutex_);
  admission_.freed_.wait(lock, [&] {
    return admission_.running_ == 0 || admission_.taken_ + bytes_ <= admission_.budget_;
  });
  ++admission_.running_;
  admission_.taken_ += bytes_;
}

Admission::Ticket::~Ticket() {
  if (!admission_.bounded()) return;
  {
    const std::lock_guard lock(admission_.mutex_);
    --admission_.running_;
    admission_.taken_ -= bytes_;
  }
  admission_.freed_.notify_all();
}

void give_memory_back() { malloc_trim(std::size_t{16} << 20); }

void bound_allocator() {
  mallopt(M_MMAP_THRESHOLD,
          512 * 1024);  // fixed: otherwise it grows with the first big block that is freed
  mallopt(M_ARENA_MAX, 4);
}

}  // namespace plumb
