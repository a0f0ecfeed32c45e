#pragma once
/// A place on disk for what is too much to hold in memory.

#include <atomic>
#include <cstddef>
#include <cstdint>

namespace plumb::io {

/// A file without a name: it is gone with this object, and with the process however that ends. Safe
/// from several threads.
class ScratchFile {
 public:
  /// In the folder that TMPDIR names, else in /var/tmp, else in /tmp. Throws Error when none of
  /// them takes a file.
  ScratchFile();
  ~ScratchFile();
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;

  /// Returns where the bytes begin. Throws Error when the disk does not take them.
  std::uint64_t append(const void* bytes, std::size_t size);
  /// Reads what was appended. Throws Error when the disk does not give it back.
  void read(std::uint64_t at, void* to, std::size_t size) const;
  std::uint64_t size() const { return size_; }

 private:
  int file_ = -1;
  std::atomic<std::uint64_t> size_ = 0;
};

}  // namespace plumb::io
