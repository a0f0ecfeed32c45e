#include "plumb/data/short_number.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace plumb {
namespace {

TEST(ShortNumber, HasFourDigitsThatCount) {
  EXPECT_EQ(short_number(42.3587236684), "42.36");
  EXPECT_EQ(short_number(0.21009999), "0.2101");
  EXPECT_EQ(short_number(-0.5), "-0.5");
  EXPECT_EQ(short_number(30), "30");
  EXPECT_EQ(short_number(0), "0");
  EXPECT_EQ(short_number(1e-9), "1e-09");
}

TEST(ShortNumber, IsWholeWhereItIsLarge) {
  EXPECT_EQ(short_number(999.96), "1000");
  EXPECT_EQ(short_number(42358.7236684), "42359");
  EXPECT_EQ(short_number(-2097152), "-2097152");
  EXPECT_EQ(short_number(1.23456e300), "1.235e+300");
}

TEST(ShortNumber, SaysWhatIsNone) {
  EXPECT_EQ(short_number(-std::nan("")), "nan");
  EXPECT_EQ(short_number(std::numeric_limits<double>::infinity()), "inf");
}

}  // namespace
}  // namespace plumb
