#include "plumb/data/file_name.hpp"

#include <gmock/gmock.h>

namespace plumb {
namespace {

TEST(FileName, IsGoodWhenItStaysInItsFolderAndIsSeenThere) {
  for (const char* name : {"map.ply", "a b", "zhang2023", "Straße", "a..b", "-o", "CON"})
    EXPECT_EQ(fault_of_file_name(name), "") << name;
  EXPECT_EQ(fault_of_file_name(std::string(200, 'x')), "");
}

TEST(FileName, IsRefusedWhenItLeavesItsFolderOrHides) {
  for (const char* name : {"", ".", "..", "../escaped", "/tmp/absolute", "a/b", "a/", ".hidden",
                           "a\nb", "\x1b[2J", "\x7f"})
    EXPECT_THAT(fault_of_file_name(name), testing::HasSubstr("is not a name for a file or folder"))
        << name;
  EXPECT_NE(fault_of_file_name(std::string(201, 'x')), "");
  EXPECT_NE(fault_of_file_name(std::string_view("a\0b", 3)), "");
}

}  // namespace
}  // namespace plumb
