#include "shared/parallel/loop.hpp"

#include <gmock/gmock.h>

#include <atomic>
#include <set>

#include "shared/parallel/loop_testing.hpp"

namespace plumb::parallel {
namespace {

using testing::ElementsAre;

TEST(Loop, OnAContextRunsAsTheContextDoes) {
  std::vector<std::size_t> order;
  const auto note = [&](std::size_t k) { order.push_back(k); };
  TestContext forwards;
  on(forwards)(3, note);
  EXPECT_THAT(order, ElementsAre(0, 1, 2));
  order.clear();
  BackwardsContext context;
  const Loop loop = on(context);
  loop(3, note);
  loop(0, note);
  EXPECT_THAT(order, ElementsAre(2, 1, 0));
}

TEST(Loop, CallsEachOnceInWhateverOrder) {
  for (const Loop& loop : {Loop(in_order), Loop(backwards), Loop(on_threads)}) {
    std::vector<std::atomic<int>> calls(103);
    loop(calls.size(), [&](std::size_t k) { ++calls[k]; });
    for (const auto& count : calls) EXPECT_EQ(count.load(), 1);
  }
}

TEST(Loop, OnThreadsLeavesTheCallersThread) {
  std::vector<std::thread::id> ids(8);
  ThreadedContext context;
  context.parallel(ids.size(), [&](std::size_t k) { ids[k] = std::this_thread::get_id(); });
  const std::set<std::thread::id> different(ids.begin(), ids.end());
  EXPECT_GE(different.size(), 2u);
  EXPECT_FALSE(different.contains(std::this_thread::get_id()));
}

}  // namespace
}  // namespace plumb::parallel
