#pragma once
/// What all readers share: a whole file in memory, its lines, its numbers, and the way to say what
/// is wrong with it.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace plumb::io {

/// The bytes of a regular file, read at once. Throws Error: something else than a file, cannot be
/// opened or read, too large.
class FileBytes {
 public:
  /// Of any size that the machine's memory takes.
  explicit FileBytes(const std::filesystem::path& file);
  /// Of `most` bytes, which no `kind` ("pipeline") is larger than.
  FileBytes(const std::filesystem::path& file, std::uint64_t most, const std::string& kind);
  std::string_view view() const { return {bytes_.get(), size_}; }

 private:
  void read(const std::filesystem::path& file, std::uint64_t most, const std::string& too_large);
  std::unique_ptr<char[]> bytes_;
  std::size_t size_ = 0;
};

/// Walks a text line by line, without its line ends ("\n" or "\r\n"), and knows where it is.
class Lines {
 public:
  explicit Lines(std::string_view text) : rest_(text) {}
  /// False at the end of the text.
  bool next(std::string_view& line);
  std::size_t number() const { return number_; }   ///< of the line given last, from 1
  std::string_view rest() const { return rest_; }  ///< all behind that line

 private:
  std::string_view rest_;
  std::size_t number_ = 0;
};

/// Takes the next word off the front of `line`; words are parted by blanks, tabs or `also`. Empty
/// at the end.
std::string_view next_word(std::string_view& line, char also = ' ');

/// The whole word as a number: false if anything else is in it. Reads nan and inf.
bool to_number(std::string_view word, double& value);
bool to_number(std::string_view word, std::uint64_t& value);

/// Throws Error: "FILE: what" or, with a line, "FILE:line: what".
[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& what);
[[noreturn]] void refuse(const std::filesystem::path& file, std::size_t line,
                         const std::string& what);

/// `word` in quotes, shortened and without control characters, for a sentence.
std::string in_quotes(std::string_view word);

}  // namespace plumb::io
