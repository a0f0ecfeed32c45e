#include "plumb/plugin/licence.hpp"

#include <gmock/gmock.h>

#include <string>
#include <utility>

namespace plumb {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

TEST(Licence, IsAnSpdxExpressionOfKnownLicences) {
  for (const char* good :
       {"BSD-3-Clause", "BSD-3-Clause AND GPL-2.0-or-later AND LGPL-2.1-or-later",
        "MIT OR (Apache-2.0 WITH LLVM-exception AND Zlib)", "((MPL-2.0))",
        "GPL-3.0-or-later WITH GCC-exception-3.1", "LicenseRef-ours.1-x", " MIT  AND Zlib "})
    EXPECT_EQ(fault_of_licence(good), "") << good;
}

TEST(Licence, ThatIsEmptyIsRefused) {
  for (const char* empty : {"", "  "})
    EXPECT_THAT(fault_of_licence(empty), StartsWith("its licence is empty; write an SPDX"));
}

TEST(Licence, ThatIsUnknownIsNamedWithTheKnownOnes) {
  for (const char* word : {"GPL", "GPL-2.0+", "bsd-3-clause", "LicenseRef-", "LicenseRef-a/b"})
    EXPECT_THAT(fault_of_licence(std::string("MIT AND ") + word),
                testing::AllOf(StartsWith(std::string("its licence 'MIT AND ") + word +
                                          "' names '" + word + "', which is not known here"),
                               HasSubstr("GPL-2.0-or-later"), HasSubstr("LicenseRef-NAME")));
  EXPECT_THAT(fault_of_licence("GPL-2.0-only WITH luck"),
              HasSubstr("names the exception 'luck', which is not known here"));
}

TEST(Licence, WhoseWordsDoNotFitTogetherIsRefusedAtTheFirstThatDoesNot) {
  const std::pair<const char*, const char*> wrong[] = {
      {"AND MIT", "has no licence before 'AND'"},
      {"MIT AND", "ends where something must follow"},
      {"MIT WITH", "ends where something must follow"},
      {"MIT Zlib", "has 'Zlib' where AND or OR is expected"},
      {"MIT and Zlib", "has 'and' where AND or OR is expected"},
      {"(MIT", "lacks a ')'"},
      {"MIT)", "has ')' where AND or OR is expected"},
      {"()", "has no licence before ')'"},
      {"(MIT) WITH LLVM-exception", "has 'WITH' where AND or OR is expected"}};
  for (const auto& [expression, fault] : wrong)
    EXPECT_EQ(fault_of_licence(expression),
              std::string("its licence '") + expression + "' " + fault);
}

TEST(Licence, MayNestAsDeepAsItLikes) {
  const std::string deep(1'000'000, '(');
  EXPECT_EQ(fault_of_licence(deep + "MIT" + std::string(deep.size(), ')')), "");
}

TEST(Licence, ThatIsNotStatedIsSaid) {
  EXPECT_EQ(Licence().text(), "not stated");
  EXPECT_EQ((Licence{"MIT", ""}).text(), "MIT");
}

}  // namespace
}  // namespace plumb
