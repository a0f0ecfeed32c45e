#pragma once
/// What stands in a file that is being made.

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <type_traits>

#include "plumb/data/io/scratch_file.hpp"

namespace plumb {

/// Bytes that grow at their end: in memory while they are few, in a temporary file beyond.
class FileBytes {
 public:
  FileBytes() = default;
  FileBytes(const FileBytes& other) {
    other.give([&](std::string_view part) { append(part); });
  }
  FileBytes(FileBytes&&) = default;
  FileBytes& operator=(FileBytes other) noexcept {
    file_ = std::move(other.file_), memory_ = std::move(other.memory_), limit_ = other.limit_;
    return *this;
  }
  FileBytes(std::string_view bytes) { append(bytes); }
  FileBytes(const std::string& bytes) { append(bytes); }
  FileBytes(const char* bytes) { append(bytes); }

  /// Throws Error when the disk does not take them.
  void append(std::string_view bytes) {
    if (memory_.size() + bytes.size() > limit_)
      spill(bytes);
    else
      memory_.append(bytes);
  }
  std::size_t size() const {
    return (file_ ? static_cast<std::size_t>(file_->size()) : 0) + memory_.size();
  }
  /// Hands on all of it, piece by piece.
  void give(const std::function<void(std::string_view)>& take) const;
  std::string text() const;

 private:
  void spill(std::string_view bytes);
  std::unique_ptr<io::ScratchFile> file_;  ///< what stands before `memory_`
  std::string memory_;
  std::size_t limit_ = std::size_t{16} << 20;
};

template <class Archive, class T>
requires std::is_same_v<std::remove_const_t<T>, FileBytes>
void fields(Archive& a, T& bytes) {
  if constexpr (Archive::reading) {
    bytes = FileBytes(a.take_bytes());
  } else {
    a(static_cast<std::uint64_t>(bytes.size()));
    bytes.give([&](std::string_view piece) { a.put(piece.data(), piece.size()); });
  }
}

}  // namespace plumb
