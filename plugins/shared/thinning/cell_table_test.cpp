#include "shared/thinning/cell_table.hpp"

#include <gtest/gtest.h>

#include <unordered_map>

#include "plumb/data/random.hpp"

namespace plumb::thinning {
namespace {

struct Counted {
  std::uint64_t key;
  std::uint32_t count;
};

TEST(CellTable, NumbersKeysInTheOrderInWhichTheyAreFirstAskedFor) {
  CellTable<Counted> table;
  std::unordered_map<std::uint64_t, std::uint32_t> numbers, counts;
  std::vector<std::uint64_t> order;
  Random random(4);
  for (int round = 0; round < 200; ++round) {
    const std::size_t n = 1 + random.below(CellTable<Counted>::batch);
    std::uint64_t keys[CellTable<Counted>::batch];
    std::uint32_t found[CellTable<Counted>::batch];
    for (std::size_t k = 0; k < n; ++k) keys[k] = std::uint64_t{random.below(20000)} << 21;
    table.find(keys, n, found);
    for (std::size_t k = 0; k < n; ++k) {
      const auto number = static_cast<std::uint32_t>(order.size());
      if (numbers.try_emplace(keys[k], number).second) order.push_back(keys[k]);
      ASSERT_EQ(found[k], numbers[keys[k]]);
      ++table[found[k]].count;
      ++counts[keys[k]];
    }
  }
  ASSERT_EQ(table.count(), order.size());
  std::size_t at = 0;
  table.take([&](const Counted& cell) {
    ASSERT_LT(at, order.size());
    EXPECT_EQ(cell.key, order[at]);
    EXPECT_EQ(cell.count, counts[order[at]]);
    ++at;
  });
  EXPECT_EQ(at, order.size());
}

}  // namespace
}  // namespace plumb::thinning
