#include "tile.hpp"

#include <gtest/gtest.h>

#include <map>

#include "bit_stream.hpp"
#include "plumb/plugin/context.hpp"

namespace plumb::write_map {
namespace {

TEST(BitStream, GivesBackWhatWasPut) {
  Random random(1);
  std::vector<std::pair<std::uint32_t, int>> numbers;  // bits 0: a short one
  BitWriter writer;
  for (int k = 0; k < 20000; ++k) {
    const int bits = static_cast<int>(random.below(33));
    const auto value = static_cast<std::uint32_t>(
        bits ? random.next() >> (64 - bits) : 1 + (random.next() >> (48 + random.below(16))));
    numbers.emplace_back(value, bits);
    bits ? writer.put(value, bits) : writer.put_short(value);
  }
  const auto words = writer.take();
  BitReader reader(words);
  for (const auto& [value, bits] : numbers)
    ASSERT_EQ(bits ? reader.get(bits) : reader.get_short(), value);
}

Cell random_cell(Random& random) {
  Cell cell;
  cell.place = static_cast<std::uint16_t>(random.next());
  if (random.below(50) == 0) cell.place = random.below(2) ? 0xffff : 0;
  const std::uint32_t count = 1 + random.below(random.below(20) == 0 ? Cell::most : 10);
  cell.count = static_cast<std::uint16_t>(count);
  for (auto& sum : cell.sum)
    sum = random.below(10) == 0 ? count * 65535u : random.below(count * 65535u);
  return cell;
}

bool same(const Cell& a, const Cell& b) {
  return a.place == b.place && a.count == b.count && a.sum == b.sum;
}

TEST(Tile, HoldsWhatAMapOfCellsHoldsHoweverOftenItIsClosed) {
  for (const std::uint32_t every : {1u, 7u, 1000u, 100000u}) {
    Random random(every);
    io::ScratchFile file;
    Tile tile;
    std::map<std::uint16_t, Cell> expected;
    for (int k = 0; k < (every == 1 ? 500 : every == 7 ? 3000 : 20000); ++k) {
      const Cell cell = random_cell(random);
      tile.add(cell);
      const auto [at, is_new] = expected.try_emplace(cell.place, cell);
      if (!is_new) at->second.add(cell);
      if (random.below(every) == 0) tile.close();
      if (random.below(3 * every) == 0) tile.sink(file);
    }
    ASSERT_EQ(tile.size(), expected.size());
    for (int round = 0; round < 2; ++round, tile.close()) {
      const auto cells = tile.cells();
      ASSERT_EQ(cells.size(), expected.size());
      auto at = expected.begin();
      for (const auto& cell : cells) ASSERT_TRUE(same(cell, (at++)->second));
    }
  }
}

TEST(Tile, IsEmptyWithoutPointsAndStaysSoWhenClosed) {
  Tile tile;
  tile.close();
  EXPECT_EQ(tile.size(), 0u);
  EXPECT_TRUE(tile.cells().empty());
}

}  // namespace
}  // namespace plumb::write_map
