/// Texts that are made to take the reader's time and memory, and files that are named to have them
/// printed.
#include <gmock/gmock.h>
#include <sys/stat.h>

#include <algorithm>
#include <functional>
#include <sstream>

#include "plumb/pipeline/testing/mistakes_testing.hpp"

namespace plumb {
namespace {

using test::cascade;
using test::told;
using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;

std::string repeated(int times, const std::function<std::string(const std::string& k)>& line) {
  std::string all;
  for (int k = 0; k < times; ++k) all += line(std::to_string(k));
  return all;
}

std::ptrdiff_t told_in(const std::string& all) {
  std::istringstream lines(all);
  std::ptrdiff_t told = 0;
  for (std::string line; std::getline(lines, line);) told += line.starts_with("a.yaml:");
  return told;
}

TEST(Mistakes, InAliasesThatStandForMoreTextThanAnyPipelineHas) {
  const std::string scalar = std::string(100000, 'x');
  const std::string uses = repeated(12, [](const std::string&) { return std::string("*a, "); });
  EXPECT_THAT(told("plumb: 1\nabout: &a " + scalar + "\nsteps: [" + uses + "]\n"),
              HasSubstr("a.yaml:3:45: more than 1 MiB of text once aliases are expanded"));
  const std::string keys =
      repeated(100, [](const auto& k) { return std::string(1000, 'x') + k + ": 1, "; });
  EXPECT_THAT(told("plumb: 1\nabout: &a {" + keys + "}\nsteps: [" + uses + "]\n"),
              HasSubstr("more than 1 MiB of text"));
  std::string nested =
      "[" + scalar + "]";  // an anchor round an anchor: each keeps all that is in it
  for (int k = 0; k < 20; ++k) nested = "[&a" + std::to_string(k) + " " + nested + "]";
  EXPECT_THAT(told("plumb: 1\nsteps: " + nested + "\n"), HasSubstr("more than 1 MiB of text"));
  const std::string few = told("plumb: 1\nabout: &a " + scalar + "\nname: *a\nsteps: {}\n");
  EXPECT_THAT(few, Not(HasSubstr("MiB")));
}

TEST(Mistakes, ThatAreManyAreToldInPart) {
  const auto of_kind = [](const std::string& text) {
    const std::string all = told(text);
    EXPECT_EQ(told_in(all), 40) << all.substr(0, 1000);
    EXPECT_THAT(all, EndsWith("\nand 60 more, and what was not looked for behind so many."));
    return all;
  };
  const auto step = [](const std::string& k) {
    return "  step" + k + ": {use: foo.bar" + k + ", from: no" + k + "}\n";
  };
  EXPECT_THAT(of_kind("plumb: 1\nsteps:\n" + repeated(4500, step)),
              HasSubstr("a.yaml:3:16: step 'step0': no module offers 'foo.bar0'."));
  of_kind("plumb: 1\nsteps: [" +
          repeated(18000, [](const auto&) { return std::string("!t x, "); }) + "]\n");
  of_kind("plumb: 1\n" + repeated(18000, [](const auto&) { return std::string("steps: 1\n"); }));
  of_kind("plumb: 1\nsteps: {}\n" +
          repeated(18000, [](const auto& k) { return "key" + k + ": 1\n"; }));
  of_kind("plumb: 1\nparameters:\n" +
          repeated(4000, [](const auto& k) { return "  p" + k + ": {type: lenth}\n"; }));
}

TEST(Mistakes, ThatAreMoreThanAnybodyReadsAreCounted) {
  const std::string all = told("plumb: 1\nsteps: {}\n" +
                               repeated(44, [](const auto& k) { return "key" + k + ": 1\n"; }));
  EXPECT_EQ(told_in(all), 40);
  EXPECT_THAT(
      all,
      EndsWith("\nand 6 more."));  // with the missing steps, and the missing parameter that is set
}

TEST(Mistakes, InLongWordsAreToldInShort) {
  const std::string all = told("plumb: 1\nsteps:\n  ? " + std::string(100000, 'k') +
                               "\n  : x\nplumb: " + std::string(50000, 'v') + "\n");
  EXPECT_LT(all.size(), 6000u);
  EXPECT_THAT(all, HasSubstr("is neither a step ('use'), nor a group"));  // how the sentence ends
}

TEST(Mistakes, InTextThatWouldSteerATerminalAreShownPlainly) {
  EXPECT_EQ(told("plumb: 1\nsteps: {}\n\x1b[2Jname: x\n").find('\x1b'), std::string::npos);
  const std::string all = told("plumb: 1\nname: a\n\"k\\e[31m\\u202e\": 1\nsteps: {}\n");
  EXPECT_THAT(all, HasSubstr("unknown key 'k\\x1b[31m\\u202e'"));
  EXPECT_THAT(told("plumb: 1\nsteps: {\"a\\nplumb: all is well\": {use: x}}\n"),
              HasSubstr("'a\\x0aplumb: all is well' is no name"));
  EXPECT_THAT(told("plumb: 1\nsteps: {\xe2\x80\xae: x}\n"),
              HasSubstr("  2 | steps: {\\u202e: x}\n    |         ^"));
}

/// What is told of a pipeline that extends `file`.
std::string told_of_extending(const std::filesystem::path& file) {
  return told("plumb: 1\nextends: " + file.string() + "\n");
}

TEST(Mistakes, DoNotPrintFilesThatAreNoPipelines) {
  const test::Folder folder;
  const auto says_nothing_of = [&](const std::string& text) {
    const std::string all = told_of_extending(folder.write("other", text));
    EXPECT_THAT(all, HasSubstr("other' is no"));
    EXPECT_THAT(all, Not(HasSubstr("secret")));
  };
  says_nothing_of("root:x:0:0:secret:/root:/bin/bash\nbin:x:1:1:secret:/bin:/sbin\n");
  says_nothing_of("secret\n");
  says_nothing_of("- secret\n- b\n");
  says_nothing_of("hosts:\n  token: secret\n  steps: {a: secret}\n");
  says_nothing_of("-----BEGIN KEY-----\nsecret: [\n");
  says_nothing_of("password = \"secret\"\n\tx: {\n");
  EXPECT_THAT(told_of_extending("/etc/passwd"),
              testing::AllOf(HasSubstr("a.yaml:2:10: '/etc/passwd' is no pipeline"),
                             Not(HasSubstr("root"))));
  EXPECT_THAT(told_of_extending(folder.write("base.yaml", "plumb: 1\nstesp: {}\n")),
              HasSubstr("2 | stesp: {}"));  // what is one is shown
}

TEST(Mistakes, OfNamingWhatIsNoFile) {
  const test::Folder folder;
  const auto pipe = folder.path() / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_THAT(told_of_extending(pipe), HasSubstr("pipe' is a pipe, not a pipeline."));
  EXPECT_THAT(told_of_extending("/dev/zero"),
              HasSubstr("'/dev/zero' is a device, not a pipeline."));
  EXPECT_THAT(told_of_extending(folder.path()), HasSubstr("is a folder, not a pipeline."));
  EXPECT_THAT(
      told_of_extending(folder.write("big", "plumb: 1\n" + std::string(1 << 20, '#'))),
      HasSubstr("big' has 1048585 bytes, and no pipeline is larger than 1 MiB: check the path."));
}

}  // namespace
}  // namespace plumb
