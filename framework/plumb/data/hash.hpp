#pragma once
/// Content hashes: 128 bits of XXH3. Equal content gives equal hashes on every machine of the same
/// byte order.

#include <compare>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

namespace plumb {

struct Hash128 {
  std::uint64_t high = 0, low = 0;
  auto operator<=>(const Hash128&) const = default;
  std::string text() const;  ///< 32 hexadecimal digits
};

/// Collects bytes and gives their hash.
class Hasher {
 public:
  Hasher();
  ~Hasher();
  Hasher(const Hasher&) = delete;
  Hasher& operator=(const Hasher&) = delete;
  void bytes(const void* data, std::size_t size);
  void text(std::string_view s);  ///< length first, so that neighbouring texts cannot run together
  Hash128 hash() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// The hash of some bytes at once.
Hash128 hash_of(std::string_view bytes);

struct Hash128Hash {
  std::size_t operator()(const Hash128& h) const { return h.low; }
};

}  // namespace plumb
