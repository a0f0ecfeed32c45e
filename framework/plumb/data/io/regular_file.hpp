#pragma once
/// The one way to open a file that somebody named: a pipe, a device or a folder in its place is
/// refused, and never waited for.

#include <fcntl.h>
#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <string>

namespace plumb::io {

/// What stands there instead of a regular file: "a pipe", "a folder", "a device", "a socket". Empty
/// for a regular file and where nothing is; links are followed. For what others open by its name,
/// as SQLite does.
std::string other_than_file(const std::filesystem::path& file);

/// A regular file, open until the end of its scope.
class RegularFile {
 public:
  /// `flags` as open(2) takes them; it never blocks and is closed in programs that are started.
  /// Throws Error: something else stands there, or it cannot be opened.
  explicit RegularFile(const std::filesystem::path& file, int flags = O_RDONLY, mode_t mode = 0666);
  RegularFile(const RegularFile&) = delete;
  RegularFile& operator=(const RegularFile&) = delete;
  ~RegularFile();

  int descriptor() const { return descriptor_; }
  std::uint64_t size() const { return size_; }  ///< [byte] when it was opened
  /// The next bytes, as many as there are up to `size`; 0 at the end. Throws Error: the disk does
  /// not give them.
  std::size_t read(char* to, std::size_t size);

 private:
  std::filesystem::path file_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
};

}  // namespace plumb::io
