#pragma once
/// The calls of a step that failed, and what follows from that.

#include <atomic>
#include <cstddef>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

namespace plumb {

/// Safe from several threads.
class Failures {
 public:
  struct Failed {
    std::size_t item;
    std::string sentence;  ///< names step and item
  };
  /// `stop`: each of them ends the run, once those that have begun are done; else its item is
  /// dropped.
  explicit Failures(bool stop) : stop_(stop) {}
  void add(std::size_t item, std::string why);
  bool has(std::size_t item) const;
  bool end_run() const { return stop_ && count_ > 0; }
  /// So many end the run that it is not the items: the rest is left out.
  bool enough() const { return stop_ && count_ >= most; }
  std::vector<Failed> all() const;  ///< by item
  /// What is told of them all: the first item's sentence, and which others failed.
  std::string sentence(const std::string& path,
                       const std::function<std::string(std::size_t)>& name_of) const;

 private:
  static constexpr std::size_t most = 16;
  const bool stop_;
  mutable std::mutex mutex_;
  std::vector<Failed> failed_;
  std::atomic<std::size_t> count_ = 0;
};

}  // namespace plumb
