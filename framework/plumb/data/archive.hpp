#pragma once
/// One list of fields per value type serves hashing, storing and reading back: `fields(archive,
/// value)`. Numbers go as they lie in memory (little endian), sequences and texts with their length
/// first. In bytes, but not in hashes, an array of plain values begins at a multiple of 16 bytes
/// from the start, so that it can be read where a file is mapped.

#include <algorithm>
#include <cstring>
#include <functional>
#include <map>
#include <string>
#include <type_traits>
#include <vector>

#include "plumb/data/error.hpp"
#include "plumb/data/hash.hpp"

namespace plumb {

/// Types whose bytes are their value: numbers and enums; a header may add such as have no padding.
template <class T>
inline constexpr bool is_plain = std::is_arithmetic_v<T> || std::is_enum_v<T>;

/// Where arrays of plain values may begin in bytes.
inline constexpr std::size_t array_alignment = 16;

/// How many bytes lie between `at` and the next place where an array may begin.
constexpr std::size_t array_padding(std::size_t at) {
  return (array_alignment - at % array_alignment) % array_alignment;
}

/// Shared by both directions of output. `Sink` has put(const void*, size_t), and align() if it pads
/// before arrays.
template <class Sink>
class OutArchive : public Sink {
 public:
  using Sink::Sink;
  static constexpr bool reading = false;

  template <class... T>
  void operator()(const T&... values) {
    (put_value(values), ...);
  }

 private:
  template <class T>
  void put_value(const T& value) {
    if constexpr (is_plain<T>) {
      this->put(&value, sizeof value);
    } else {
      fields(*this, value);
    }
  }
  void put_value(const std::string& s) {
    put_value(static_cast<std::uint64_t>(s.size()));
    this->put(s.data(), s.size());
  }
  template <class T>
  void put_value(const std::vector<T>& values) {
    put_value(static_cast<std::uint64_t>(values.size()));
    if constexpr (is_plain<T>) {
      if constexpr (requires { this->align(); })
        if (!values.empty()) this->align();
      this->put(values.data(), values.size() * sizeof(T));
    } else {
      for (const auto& value : values) put_value(value);
    }
  }
  template <class K, class V>
  void put_value(const std::map<K, V>& values) {
    put_value(static_cast<std::uint64_t>(values.size()));
    for (const auto& [key, value] : values) (*this)(key, value);
  }
};

struct HashSink {
  Hasher hasher;
  void put(const void* data, std::size_t size) { hasher.bytes(data, size); }
};
struct TextSink {
  std::string text;
  std::function<void(std::string_view)>
      take;  ///< if given: gets the bytes as they come, so that `text` never holds much
  std::size_t taken = 0;

  void put(const void* data, std::size_t size) {
    if (take && text.size() + size > most_held) {
      flush();
      if (size > most_held) return pass({static_cast<const char*>(data), size});
    }
    text.append(static_cast<const char*>(data), size);
  }
  void align() { text.append(array_padding(taken + text.size()), '\0'); }
  /// Hands on what `text` holds.
  void flush() {
    pass(text);
    text.clear();
  }

 private:
  static constexpr std::size_t most_held = std::size_t{4} << 20;
  void pass(std::string_view bytes) {
    take(bytes);
    taken += bytes.size();
  }
};

/// Reads what an OutArchive<TextSink> wrote; `bytes` are all of it, from the start. Throws Error
/// when they end too early.
class InArchive {
 public:
  static constexpr bool reading = true;
  explicit InArchive(std::string_view bytes) : bytes_(bytes) {}

  template <class... T>
  void operator()(T&... values) {
    (take_value(values), ...);
  }
  /// Bytes whose number stands before them.
  std::string_view take_bytes() {
    const std::size_t n = take_size(1);
    return {take(n), n};
  }
  bool at_end() const { return at_ == bytes_.size(); }

 private:
  const char* take(std::size_t size) {
    if (size > bytes_.size() - at_) throw Error("stored value ends too early");
    at_ += size;
    return bytes_.data() + at_ - size;
  }
  std::size_t take_size(std::size_t element) {
    std::uint64_t n = 0;
    take_value(n);
    if (n > (bytes_.size() - at_) / element) throw Error("stored value ends too early");
    return static_cast<std::size_t>(n);
  }
  template <class T>
  void take_value(T& value) {
    if constexpr (is_plain<T>) {
      std::memcpy(static_cast<void*>(&value), take(sizeof value), sizeof value);
    } else {
      fields(*this, value);
    }
  }
  void take_value(bool& value) {
    const char byte = *take(1);
    if (byte != 0 && byte != 1) throw Error("stored value has a yes or no that is neither");
    value = byte == 1;
  }
  void take_value(std::string& s) {
    const std::size_t n = take_size(1);
    s.assign(take(n), n);
  }
  template <class T>
  void take_value(std::vector<T>& values) {
    if constexpr (is_plain<T>) {
      values.resize(take_size(sizeof(T)));
      if (values.empty()) return;
      take(array_padding(at_));
      std::memcpy(static_cast<void*>(values.data()), take(values.size() * sizeof(T)),
                  values.size() * sizeof(T));
    } else {
      values.clear();
      const std::size_t n = take_size(1);
      values.reserve(
          std::min(n, (bytes_.size() - at_) / sizeof(T) + 1));  // what is said need not be there
      for (std::size_t k = 0; k < n; ++k) take_value(values.emplace_back());
    }
  }
  template <class K, class V>
  void take_value(std::map<K, V>& values) {
    values.clear();
    for (std::size_t n = take_size(1); n > 0; --n) {
      K key;
      take_value(key);
      take_value(values[key]);
    }
  }
  std::string_view bytes_;
  std::size_t at_ = 0;
};

template <class Archive, class T>
requires std::is_same_v<std::remove_const_t<T>, Hash128>
void fields(Archive& a, T& h) { a(h.high, h.low); }

/// Hash of a value's content.
template <class T>
Hash128 content_hash(const T& value) {
  OutArchive<HashSink> archive;
  archive(value);
  return archive.hasher.hash();
}

/// A value as bytes, and back.
template <class T>
std::string to_bytes(const T& value) {
  OutArchive<TextSink> archive;
  archive(value);
  return std::move(archive.text);
}
template <class T>
T from_bytes(std::string_view bytes) {
  InArchive archive(bytes);
  T value;
  archive(value);
  if (!archive.at_end()) throw Error("stored value has bytes left over");
  return value;
}

}  // namespace plumb
