#include "plumb/data/counted.hpp"

#include <gtest/gtest.h>

namespace plumb {
namespace {

TEST(Counted, IsSingularForOneAndAsItIsForAnyOtherNumber) {
  EXPECT_EQ(counted(0, "scans read"), "0 scans read");
  EXPECT_EQ(counted(1, "scans read"), "1 scan read");
  EXPECT_EQ(counted(2, "scans read"), "2 scans read");
  EXPECT_EQ(counted(1, "passes"), "1 pass");
  EXPECT_EQ(counted(1, "matches passed on"), "1 match passed on");
  EXPECT_EQ(counted(1, "poses"), "1 pose");
  EXPECT_EQ(counted(1, "entries for 2 fields"), "1 entry for 2 fields");
  EXPECT_EQ(counted(1, "pairs whose boxes meet"), "1 pair whose boxes meet");
}

TEST(Counted, TakesTheNounForTheFirstPluralOfTheFirstTwoWords) {
  EXPECT_EQ(counted(1, "damaged scans left out"), "1 damaged scan left out");
  EXPECT_EQ(counted(1, "loops dropped: alone and far"), "1 loop dropped: alone and far");
  EXPECT_EQ(counted(1, "edges, of which none"), "1 edge, of which none");
  EXPECT_EQ(counted(1, "more sentences of other kinds"), "1 more sentence of other kinds");
}

TEST(Counted, LeavesWhatIsNoPlural) {
  EXPECT_EQ(counted(1, "searched again in all headings"), "1 searched again in all headings");
  EXPECT_EQ(counted(1, "of these after a stretch without scans"),
            "1 of these after a stretch without scans");
  EXPECT_EQ(counted(1, "loss"), "1 loss");
  EXPECT_EQ(counted(1, "series of scans"), "1 series of scans");
  EXPECT_EQ(counted(1, ""), "1 ");
}

}  // namespace
}  // namespace plumb
