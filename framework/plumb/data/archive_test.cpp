#include "plumb/data/archive.hpp"

#include <gtest/gtest.h>

#include <array>

namespace plumb {
namespace {

/// Takes 500 bytes in memory, and as many when it is written.
struct Large {
  std::array<double, 62> numbers{};
};
template <class Archive, class T>
requires std::is_same_v<std::remove_const_t<T>, Large>
void fields(Archive& a, T& large) {
  for (auto& number : large.numbers) a(number);
}

/// Bytes that say that `n` elements follow, and hold `rest` bytes.
std::string saying(std::uint64_t n, std::size_t rest) {
  return std::string(reinterpret_cast<const char*>(&n), sizeof n) + std::string(rest, '\0');
}

TEST(Archive, TakesNoMemoryForElementsThatAreNotThere) {
  // As many as are said would be 8 GB.
  EXPECT_THROW(from_bytes<std::vector<Large>>(saying(std::uint64_t{1} << 24, std::size_t{1} << 24)),
               Error);
  EXPECT_THROW(from_bytes<std::vector<std::string>>(saying(std::uint64_t{1} << 60, 100)), Error);
  EXPECT_THROW(from_bytes<std::vector<float>>(saying(std::uint64_t{1} << 62, 100)), Error);
}

TEST(Archive, GivesBackSequencesOfSequences) {
  const std::vector<std::vector<std::string>> value = {{"a", "bc"}, {}, {"", "def"}};
  EXPECT_EQ(from_bytes<std::vector<std::vector<std::string>>>(to_bytes(value)), value);
}

TEST(Archive, RefusesAYesOrNoThatIsNeither) {
  EXPECT_TRUE(from_bytes<bool>(std::string(1, '\1')));
  for (const char byte : {'\2', '\x10', '\xff'})
    EXPECT_THROW(from_bytes<bool>(std::string(1, byte)), Error);
}

}  // namespace
}  // namespace plumb
