#pragma once
/// Numbers of a few bits each, one after another in whole 64-bit words.

#include <bit>
#include <cstdint>
#include <vector>

namespace plumb::write_map {

class BitWriter {
 public:
  /// The low `bits` (0 to 32) bits of `value`, which has no others.
  void put(std::uint64_t value, int bits) {
    word_ |= value << fill_;
    fill_ += bits;
    if (fill_ < 64) return;
    words_.push_back(word_);
    fill_ -= 64;
    word_ = fill_ ? value >> (bits - fill_) : 0;
  }
  /// A number from 1 on in 2 log2 + 1 bits: small ones are short. Source: Elias 1975, the gamma
  /// code.
  void put_short(std::uint32_t value) {
    const int low = std::bit_width(value) - 1;
    put(std::uint64_t{1} << low, low + 1);
    put(value ^ std::uint32_t{1} << low, low);
  }
  /// All words, and no more memory than they take; one word more than was written, so that a reader
  /// may look ahead.
  std::vector<std::uint64_t> take() {
    if (fill_) words_.push_back(word_);
    words_.push_back(0);
    std::vector<std::uint64_t> exact(words_.begin(), words_.end());
    words_.clear();
    word_ = 0, fill_ = 0;
    return exact;
  }

 private:
  std::vector<std::uint64_t> words_;
  std::uint64_t word_ = 0;
  int fill_ = 0;
};

/// Reads what a BitWriter wrote, by the same calls in the same order.
class BitReader {
 public:
  explicit BitReader(const std::vector<std::uint64_t>& words) : words_(words.data()) {}
  std::uint32_t get(int bits) {
    const std::uint64_t value = ahead() & ((std::uint64_t{1} << bits) - 1);
    at_ += static_cast<unsigned>(bits);
    return static_cast<std::uint32_t>(value);
  }
  std::uint32_t get_short() {
    const int low = std::countr_zero(ahead());
    at_ += static_cast<unsigned>(low) + 1;
    return get(low) | std::uint32_t{1} << low;
  }

 private:
  /// The next 64 bits.
  std::uint64_t ahead() const {
    const auto* word = words_ + (at_ >> 6);
    const unsigned shift = at_ & 63;
    return shift ? word[0] >> shift | word[1] << (64 - shift) : word[0];
  }
  const std::uint64_t* words_;
  std::size_t at_ = 0;
};

}  // namespace plumb::write_map
