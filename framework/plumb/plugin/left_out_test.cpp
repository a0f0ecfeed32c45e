#include "plumb/plugin/left_out.hpp"

#include <gmock/gmock.h>
#include <sys/stat.h>

#include "plumb/data/io/file_testing.hpp"
#include "plumb/plugin/registry.hpp"

namespace plumb {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Pair;

const std::string pcl = "PCL was not found; install libpcl-dev and build again";

TEST(LeftOut, IsAStepAndAReasonALine) {
  EXPECT_THAT(read_left_out("", "f"), IsEmpty());
  EXPECT_THAT(read_left_out("keypoints.iss: " + pcl + "\ndescribe.shot: it: that\n", "f"),
              ElementsAre(Pair("describe.shot", "it: that"), Pair("keypoints.iss", pcl)));
}

TEST(LeftOut, OfAnotherFormIsRefusedWithItsLine) {
  for (const char* line : {"keypoints.iss", ": PCL", "keypoints.iss: ", "keypoints.iss:PCL", ""})
    EXPECT_THAT(io::refusal([&] { read_left_out("a.b: c\n" + (line + std::string("\n")), "f"); }),
                HasSubstr("f:2: expected 'STEP: WHY', found '"))
        << line;
}

struct LeftOutBeside : testing::Test {
  io::TestFolder folder;
  fs::path modules = folder.path() / "modules";
  LeftOutBeside() {
    fs::create_directory(modules);
    chmod(modules.c_str(), 0755);
  }
  fs::path write(const std::string& text, mode_t mode = 0644) const {
    const fs::path file = folder.write("modules/left_out.txt", text);
    chmod(file.c_str(), mode);
    return file;
  }
};

TEST_F(LeftOutBeside, IsKnownToTheRegistry) {
  EXPECT_THAT(Registry::scan({modules}).left_out(), IsEmpty());
  write("keypoints.iss: " + pcl + "\n");
  const Registry registry = Registry::scan({modules});
  EXPECT_THAT(registry.left_out(), ElementsAre(Pair("keypoints.iss", pcl)));
  EXPECT_THAT(registry.refused(), IsEmpty());
}

TEST_F(LeftOutBeside, OfTheFirstFolderThatSaysSoCounts) {
  write("keypoints.iss: " + pcl + "\n");
  const fs::path other = folder.path() / "other";
  const fs::path file = folder.write("other/left_out.txt", "keypoints.iss: moved\na.b: c\n");
  chmod(other.c_str(), 0755), chmod(file.c_str(), 0644);
  EXPECT_THAT(Registry::scan({modules, other}).left_out(),
              ElementsAre(Pair("a.b", "c"), Pair("keypoints.iss", pcl)));
}

TEST_F(LeftOutBeside, ThatIsNotTheBuildsIsRefused) {
  const auto why = [&] {
    const Registry registry = Registry::scan({modules});
    EXPECT_THAT(registry.left_out(), IsEmpty());
    return registry.refused().size() == 1 ? registry.refused()[0].why : "nothing is refused";
  };
  const fs::path file = write("keypoints.iss\n");
  EXPECT_THAT(why(), HasSubstr(file.string() + ":1: expected 'STEP: WHY'"));
  write("keypoints.iss: " + pcl + "\n", 0666);
  EXPECT_THAT(why(), HasSubstr(file.string() + " may be written by everybody"));
  fs::remove(file);
  mkfifo(file.c_str(), 0644);
  EXPECT_THAT(why(), HasSubstr("is a pipe, not a regular file"));
}

}  // namespace
}  // namespace plumb
