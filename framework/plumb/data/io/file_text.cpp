#include "plumb/data/io/file_text.hpp"

#include <unistd.h>

#include <charconv>

#include "plumb/data/error.hpp"
#include "plumb/data/io/regular_file.hpp"

namespace plumb::io {
namespace {

/// [byte] of the machine's memory.
std::uint64_t whole_memory() {
  static const auto bytes = static_cast<std::uint64_t>(sysconf(_SC_PHYS_PAGES)) *
                            static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
  return bytes;
}

bool parts(char c, char also) { return c == ' ' || c == '\t' || c == also; }

template <class T>
bool whole_word(std::string_view word, T& value) {
  if (word.size() > 1 && word.front() == '+' && word[1] != '-') word.remove_prefix(1);
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return error == std::errc() && end == word.data() + word.size();
}

}  // namespace

FileBytes::FileBytes(const std::filesystem::path& file) {
  read(file, whole_memory(), "more than this machine's memory holds: give a smaller one");
}

FileBytes::FileBytes(const std::filesystem::path& file, std::uint64_t most,
                     const std::string& kind) {
  read(file, most,
       "and no " + kind + " is larger than " + std::to_string(most >> 20) + " MiB: check the path");
}

void FileBytes::read(const std::filesystem::path& file, std::uint64_t most,
                     const std::string& too_large) {
  RegularFile from(file);
  if (from.size() > most)
    refuse(file, "has " + std::to_string(from.size()) + " bytes, " + too_large);
  size_ = static_cast<std::size_t>(from.size());
  bytes_ = std::make_unique_for_overwrite<char[]>(size_);
  for (std::size_t have = 0; have < size_;) {
    const std::size_t got = from.read(bytes_.get() + have, size_ - have);
    if (got == 0)
      refuse(file, "could be read only up to byte " + std::to_string(have) + " of " +
                       std::to_string(size_) +
                       ": check the disk, or whether it is still being written");
    have += got;
  }
}

bool Lines::next(std::string_view& line) {
  if (rest_.empty()) return false;
  const std::size_t end = rest_.find('\n');
  line = rest_.substr(0, end);
  rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  ++number_;
  return true;
}

std::string_view next_word(std::string_view& line, char also) {
  std::size_t begin = 0;
  while (begin < line.size() && parts(line[begin], also)) ++begin;
  std::size_t end = begin;
  while (end < line.size() && !parts(line[end], also)) ++end;
  const std::string_view word = line.substr(begin, end - begin);
  line.remove_prefix(end);
  return word;
}

bool to_number(std::string_view word, double& value) { return whole_word(word, value); }
bool to_number(std::string_view word, std::uint64_t& value) { return whole_word(word, value); }

void refuse(const std::filesystem::path& file, const std::string& what) {
  throw Error(file.string() + ": " + what);
}

void refuse(const std::filesystem::path& file, std::size_t line, const std::string& what) {
  throw Error(file.string() + ":" + std::to_string(line) + ": " + what);
}

std::string in_quotes(std::string_view word) {
  std::string result = "'";
  for (const char c : word.substr(0, 40)) result += c >= ' ' && c <= '~' ? c : '?';
  return result + (word.size() > 40 ? "...'" : "'");
}

}  // namespace plumb::io
