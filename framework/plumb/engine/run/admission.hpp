#pragma once
/// Lets calls begin only while the memory that they are expected to need is free.

#include <condition_variable>
#include <cstddef>
#include <mutex>

namespace plumb {

/// Safe from several threads. A call that alone needs more than there is runs when no other does.
class Admission {
 public:
  /// `budget` [bytes] for all calls together; 0: no bound.
  explicit Admission(std::size_t budget) : budget_(budget) {}

  /// Held while a call runs.
  class Ticket {
   public:
    Ticket(Admission& admission, std::size_t bytes);
    ~Ticket();
    Ticket(const Ticket&) = delete;
    Ticket& operator=(const Ticket&) = delete;

   private:
    Admission& admission_;
    std::size_t bytes_;
  };
  bool bounded() const { return budget_ > 0; }

 private:
  std::size_t budget_, taken_ = 0, running_ = 0;
  std::mutex mutex_;
  std::condition_variable freed_;
};

/// Gives memory that was freed back to the system, which the allocator does not do by itself. Does
/// nothing while little is held.
void give_memory_back();

/// Sets the allocator up for a run whose memory is bounded: big blocks go back when they are freed.
void bound_allocator();

}  // namespace plumb
