#include "plumb/slam/io/bin_file.hpp"

#include <gmock/gmock.h>

#include <limits>

#include "plumb/data/io/file_testing.hpp"
#include "plumb/slam/io/frame_files.hpp"

namespace plumb {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;

struct BinFile : testing::Test {
  io::TestFolder folder;

  fs::path write(const std::string& name, const std::vector<float>& values,
                 std::size_t cut = 0) const {
    return folder.write(
        name, std::string(reinterpret_cast<const char*>(values.data()), 4 * values.size() - cut));
  }
};

TEST_F(BinFile, GivesPointsWithIntensityAndDropsWhatIsNoNumber) {
  const float nan = std::numeric_limits<float>::quiet_NaN(),
              inf = std::numeric_limits<float>::infinity();
  const auto [cloud, dropped] =
      read_bin(write("a.bin", {1, 2, 3, 4, 0, nan, 0, 5, 6, 7, 8, 9, -inf, 0, 0, 0}));
  EXPECT_EQ(dropped, 2u);
  EXPECT_THAT(cloud.x, ElementsAre(1, 6));
  EXPECT_THAT(cloud.z, ElementsAre(3, 8));
  EXPECT_THAT(cloud.intensity, ElementsAre(4, 9));
}

TEST_F(BinFile, MayBeEmptyButNotCutShort) {
  EXPECT_TRUE(read_bin(write("empty.bin", {})).cloud.empty());
  const fs::path cut = write("cut.bin", {1, 2, 3, 4, 5, 6, 7, 8}, 1);
  EXPECT_THAT(io::refusal([&] { read_bin(cut); }),
              HasSubstr("cut.bin: has 31 bytes, which is not a multiple of 16"));
}

TEST_F(BinFile, IsFoundByItsEndingInOrderOfNames) {
  for (const char* name : {"10.bin", "09.bin", "._09.bin", "notes.txt"}) write(name, {});
  const auto files = io::files_in(folder.path(), {".bin"}, "scans/");
  ASSERT_EQ(files.size(), 2u);
  EXPECT_EQ(files[0].name, "scans/09.bin");
  EXPECT_EQ(files[1].path, folder.path() / "10.bin");
}

}  // namespace
}  // namespace plumb
