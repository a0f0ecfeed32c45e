#include "plumb/plugin/unit.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace plumb {
namespace {

TEST(Unit, OfAWrittenValueIsTheOneThatPeopleUse) {
  EXPECT_EQ(written(0.3, Quantity::length), "0.3 m");
  EXPECT_EQ(written(0.001, Quantity::length), "0.001 m");
  EXPECT_EQ(written(10000, Quantity::length), "10000 m");
  EXPECT_EQ(written(std::numbers::pi / 4, Quantity::angle), "45 deg");
  EXPECT_EQ(written(0.57, Quantity::ratio), "57 %");
  EXPECT_EQ(written(90, Quantity::time), "90 s");
  EXPECT_EQ(written(10, Quantity::speed), "10 m/s");
  EXPECT_EQ(written(0.25, Quantity::none), "0.25");
}

TEST(Unit, OfAWrittenValueIsAnotherWhereOnlyThereTheNumberIsRound) {
  EXPECT_EQ(written(0.001, Quantity::angle), "0.001 rad");
  EXPECT_EQ(written(0.1, Quantity::curvature), "0.1 rad/m");
  EXPECT_EQ(written(5 / 3.6, Quantity::speed), "5 km/h");
  EXPECT_EQ(written(0.123456789, Quantity::angle), "7.07355296194 deg") << "it is odd in both";
}

}  // namespace
}  // namespace plumb
