#pragma once
/// Folders by their handles: what is done is done in this very folder, wherever its path leads by
/// then, and no link in it is followed.

#include <cerrno>
#include <compare>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "plumb/data/hash.hpp"

namespace plumb::io {

/// An open file or folder; closed at the end of its scope.
class Handle {
 public:
  Handle() = default;
  explicit Handle(int number) : number_(number) {}
  Handle(Handle&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }
  ~Handle() { close(); }

  explicit operator bool() const { return number_ >= 0; }
  int number() const { return number_; }
  int release() { return std::exchange(number_, -1); }
  /// False, with errno: what was written may be lost.
  bool close();

 private:
  int number_ = -1;
};

/// A system call, again for as long as a signal interrupts it.
template <class Call>
auto uninterrupted(Call&& call) {
  for (;;)
    if (const auto result = call(); result != -1 || errno != EINTR) return result;
}

/// What changes when a file does.
struct FileStamp {
  std::uint64_t inode = 0, size = 0;
  std::int64_t changed = 0, touched = 0;  ///< its content, and whatever of it [ns]
  auto operator<=>(const FileStamp&) const = default;
};

/// A regular file and what stands in it.
struct HashedFile {
  FileStamp stamp;
  Hash128 hash;
};

/// All functions that can fail give nothing or false, with errno. Names are of one level, but for
/// `inner`.
class Folder {
 public:
  Folder() = default;
  /// The folder that a path leads to.
  explicit Folder(const std::filesystem::path& path);

  explicit operator bool() const { return static_cast<bool>(handle_); }
  int number() const { return handle_.number(); }
  std::uint64_t inode() const;

  /// A folder in this one, however deep ("a/b"); itself for "".
  Folder inner(const std::string& relative) const;
  std::optional<std::vector<std::string>> names() const;          ///< sorted
  std::optional<FileStamp> stamp(const std::string& name) const;  ///< of a regular file
  std::optional<HashedFile> hashed(
      const std::string& name) const;  ///< nothing also when it changes meanwhile
  std::optional<std::string> text(const std::string& name, std::size_t most) const;
  std::optional<std::uint64_t> inode_of(
      const std::string& name) const;         ///< of a folder; 0 of anything else
  bool lacks(const std::string& name) const;  ///< false also when that cannot be told
  bool sync() const;

 private:
  Handle handle_;
};

using Take = std::function<void(std::string_view)>;

/// All of the bytes, or false with errno.
bool write_all(int file, std::string_view bytes);
/// Until the disk has it; true where a file system knows no such thing.
bool sync_handle(int handle);

}  // namespace plumb::io
