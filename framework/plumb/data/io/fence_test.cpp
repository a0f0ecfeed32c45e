#include "plumb/data/io/fence.hpp"

#include <gmock/gmock.h>

#include <fstream>

#include "plumb/data/io/file_testing.hpp"
#include "plumb/data/io/regular_file.hpp"

namespace plumb::io {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

/// in/a.txt and out/b.txt, links to the latter, and a fence round `in` while the test runs.
struct Fence : testing::Test {
  TestFolder folder;
  fs::path in = folder.path() / "in", out = folder.path() / "out";
  Fence() {
    fs::create_directories(in / "deep");
    fs::create_directories(out);
    for (const fs::path& file :
         {in / "a.txt", in / "deep/c.txt", out / "b.txt", folder.path() / "inside.txt"})
      std::ofstream(file) << "x";
    fs::create_symlink(out / "b.txt", in / "link.txt");
    fs::create_symlink(out, in / "linked");
    fs::create_symlink("loop", in / "loop");
    fs::create_symlink(in, out / "back");
    set_fence({in});
  }
  ~Fence() override { set_fence({"/"}); }
};

TEST_F(Fence, LetsReadWhatLiesInAPlace) {
  for (const fs::path& file :
       {in / "a.txt", in / "deep/c.txt", in / "deep/../a.txt", out / "back/a.txt"}) {
    EXPECT_TRUE(inside_of_fence(file)) << file;
    EXPECT_EQ(RegularFile(file).size(), 1u);
  }
  EXPECT_TRUE(inside_of_fence(in / "not/there.txt"));
  EXPECT_TRUE(inside_of_fence(in.string() + "/"));
}

TEST_F(Fence, KeepsOutWhatALinkOrDotsLeadTo) {
  for (const fs::path& file :
       {out / "b.txt", in / "link.txt", in / "linked/b.txt", in / "../out/b.txt",
        folder.path() / "inside.txt", fs::path("/etc/passwd"), in / "loop", fs::path(""),
        in / "linked/not/there"}) {
    EXPECT_FALSE(inside_of_fence(file)) << file;
    EXPECT_THAT(refusal([&] { RegularFile{file}; }),
                HasSubstr("lies outside of what --untrusted lets a pipeline read"))
        << file;
  }
}

TEST_F(Fence, APlaceMayBeAFileOrALink) {
  set_fence({in / "link.txt"});
  EXPECT_TRUE(inside_of_fence(out / "b.txt"));
  EXPECT_FALSE(inside_of_fence(in / "a.txt"));
  set_fence({});
  EXPECT_FALSE(inside_of_fence(in / "a.txt"));
}

TEST_F(Fence, InsideNeedsNoFence) {
  EXPECT_TRUE(inside(in / "a.txt", {out, in}));
  EXPECT_FALSE(inside(in / "link.txt", {in}));
  EXPECT_FALSE(inside(in / "a.txt", {}));
}

}  // namespace
}  // namespace plumb::io
