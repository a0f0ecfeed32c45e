#pragma once
/// An undirected graph as a matrix of bits.

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace plumb::point_pairs {

/// Vertices 0 .. n-1, n^2 / 8 bytes. Row a has bit b, of its word b / 64, where a and b are joined.
class BitGraph {
 public:
  explicit BitGraph(std::size_t vertices)
      : n_(vertices), words_((vertices + 63) / 64), bits_(n_ * words_, 0) {}

  std::size_t size() const { return n_; }
  std::size_t words() const { return words_; }  ///< of a row
  std::span<const std::uint64_t> row(std::size_t a) const {
    return {bits_.data() + a * words_, words_};
  }
  bool joined(std::size_t a, std::size_t b) const { return row(a)[b / 64] >> (b % 64) & 1; }
  void join(std::size_t a, std::size_t b) {
    set(a, b);
    set(b, a);
  }
  std::uint32_t degree(std::size_t a) const {
    std::uint32_t count = 0;
    for (const std::uint64_t word : row(a))
      count += static_cast<std::uint32_t>(std::popcount(word));
    return count;
  }
  /// How many vertices both are joined to.
  std::uint32_t common(std::size_t a, std::size_t b) const {
    const auto of_a = row(a), of_b = row(b);
    std::uint32_t count = 0;
    for (std::size_t w = 0; w < words_; ++w)
      count += static_cast<std::uint32_t>(std::popcount(of_a[w] & of_b[w]));
    return count;
  }

 private:
  void set(std::size_t a, std::size_t b) {
    bits_[a * words_ + b / 64] |= std::uint64_t{1} << (b % 64);
  }
  std::size_t n_, words_;
  std::vector<std::uint64_t> bits_;
};

/// Calls see(k) for each bit k that is set, in order.
template <class See>
void for_each_bit(std::span<const std::uint64_t> words, const See& see) {
  for (std::size_t w = 0; w < words.size(); ++w)
    for (std::uint64_t left = words[w]; left != 0; left &= left - 1)
      see(static_cast<std::uint32_t>(w * 64 + static_cast<std::size_t>(std::countr_zero(left))));
}

}  // namespace plumb::point_pairs
