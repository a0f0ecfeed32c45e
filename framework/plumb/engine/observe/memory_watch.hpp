#pragma once
/// The most memory that a run held, as a whole and while each step ran.

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace plumb {

/// Resident memory of a process without mapped files and shared memory [bytes]: `resident` less
/// `shared` of /proc/PID/statm. 0 for a process that is gone. Pages that a forked process still
/// shares with its parent count in both.
std::size_t resident_bytes(int process);

/// Looks at the memory of this process, and of those that are added, every few milliseconds on a
/// thread of its own, and where a step begins and ends. What is held for less than the interval may
/// be missed. Safe from several threads.
class MemoryWatch {
 public:
  explicit MemoryWatch(std::chrono::milliseconds interval = std::chrono::milliseconds(20));
  ~MemoryWatch();
  MemoryWatch(const MemoryWatch&) = delete;
  MemoryWatch& operator=(const MemoryWatch&) = delete;

  /// From here to end(), what is seen counts for the step too. Several may run at once: each has
  /// all that is held.
  void begin(const std::string& step);
  std::size_t end(const std::string& step);  ///< the peak since its begin [bytes]

  void add_process(int process);  ///< its memory is added from now on, as long as it lives
  void remove_process(int process);

  std::size_t last() const { return last_; }  ///< what was seen last [bytes]; costs nothing
  std::size_t peak() const { return peak_; }  ///< the most that was seen [bytes]

 private:
  struct Running {
    std::string step;
    std::size_t peak;
  };
  void look();  ///< mutex_ is held
  const std::chrono::milliseconds interval_;
  std::mutex mutex_;
  std::condition_variable wake_;
  std::vector<int> processes_;
  std::vector<Running> running_;
  std::atomic<std::size_t> last_ = 0, peak_ = 0;
  bool stop_ = false;
  std::thread thread_;
};

}  // namespace plumb
