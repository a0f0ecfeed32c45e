#include "plumb/data/io/plain_text.hpp"

#include <gtest/gtest.h>

#include <ostream>
#include <sstream>

namespace plumb::io {
namespace {

TEST(PlainText, StaysAsItIs) {
  for (const char* text :
       {"", "leaf: 0.3 m", "C:\\x1b", "Gefällt mir", "点群", "\xf0\x9f\x98\x80"}) {
    EXPECT_EQ(plain(text), text);
    EXPECT_EQ(plain_lines(text), text);
  }
}

TEST(PlainText, ShowsWhatWouldSteerATerminal) {
  EXPECT_EQ(plain("\x1b[31mred"), "\\x1b[31mred");
  EXPECT_EQ(plain("a\rb\bc\x7f"), "a\\x0db\\x08c\\x7f");
  EXPECT_EQ(plain(std::string_view("a\0b", 3)), "a\\x00b");
  EXPECT_EQ(plain("\xc2\x9b"
                  "31m"),
            "\\u009b31m");  // the one-character form of ESC [, in UTF-8
  EXPECT_EQ(plain("\x9b"
                  "31m"),
            "\\x9b31m");  // and in eight bits
  EXPECT_EQ(plain("\xe2\x80\xae"
                  "gnp.exe"),
            "\\u202egnp.exe");
  EXPECT_EQ(plain("a\xe2\x81\xa6"
                  "b\xd8\x9c"
                  "c\xe2\x80\x8b"),
            "a\\u2066b\\u061cc\\u200b");
  EXPECT_EQ(plain("\xf3\xa0\x81\x81"), "\\U000e0041");
}

TEST(PlainText, ShowsWhatIsNoUtf8) {
  EXPECT_EQ(plain("gef\xe4llt"), "gef\\xe4llt");
  EXPECT_EQ(plain("\xc0\xaf"), "\\xc0\\xaf");           // an overlong '/'
  EXPECT_EQ(plain("\xed\xa0\x80"), "\\xed\\xa0\\x80");  // half of a surrogate pair
  EXPECT_EQ(plain("\xf5\x80\x80\x80"), "\\xf5\\x80\\x80\\x80");
  EXPECT_EQ(plain("\xe7\x82"), "\\xe7\\x82");  // cut off
  EXPECT_EQ(plain("\xe7\x82\n"), "\\xe7\\x82\\x0a");
}

TEST(PlainText, IsOneLineOrKeepsItsLines) {
  EXPECT_EQ(plain("a\n\tb\xe2\x80\xa8"
                  "c"),
            "a\\x0a\\x09b\\u2028c");
  EXPECT_EQ(plain_lines("a\n\tb\xe2\x80\xa8"
                        "c"),
            "a\n\tb\\u2028c");
}

TEST(PlainText, OfPlainTextIsTheSame) {
  std::string all;
  for (int c = 0; c < 256; ++c) ((all += static_cast<char>(c)) += 'x') += "\xe2\x80\xae";
  EXPECT_EQ(plain(plain(all)), plain(all));
  EXPECT_EQ(plain_lines(plain(all)), plain(all));
}

TEST(PlainText, InQuotesIsReadBackByOthers) {
  EXPECT_EQ(plain_in_quotes("a \"b\" \\ \x1b \xe2\x80\xae"), "\"a \\\"b\\\" \\\\ \\x1b \\u202e\"");
  EXPECT_EQ(plain_in_quotes("gef\xe4llt"), "\"gef\xe4llt\"");
}

TEST(PlainBuffer, GivesTheSameHoweverTheTextIsCut) {
  const std::string text = "a\x1b[0m\n\xe2\x80\xae点\xf0\x9f\x98\x80\xc2\x9b\xe4\xff\xe7\x82";
  for (std::size_t first = 0; first <= text.size(); ++first)
    for (std::size_t second = first; second <= text.size(); ++second) {
      std::stringbuf to;
      {
        PlainBuffer buffer(to);
        std::ostream out(&buffer);
        out << text.substr(0, first) << text.substr(first, second - first);
        for (const char c : text.substr(second)) out.put(c);
      }
      ASSERT_EQ(to.str(), plain_lines(text)) << first << ' ' << second;
    }
}

TEST(PlainBuffer, SaysWhenNothingCanBeWritten) {
  struct Full : std::streambuf {
  } full;  // takes nothing
  PlainBuffer buffer(full);
  std::ostream out(&buffer);
  out << "some words";
  EXPECT_TRUE(out.bad());
}

}  // namespace
}  // namespace plumb::io
