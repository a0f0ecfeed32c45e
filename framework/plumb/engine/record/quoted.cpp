#include "plumb/engine/record/quoted.hpp"

#include <algorithm>
#include <cctype>

namespace plumb {
namespace {

int digit(char c) {
  return c >= '0' && c <= '9' ? c - '0' : c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

}  // namespace

std::string in_quotes(const std::string& text) {
  constexpr char digits[] = "0123456789ABCDEF";
  std::string all = "\"";
  for (const unsigned char c : text) {
    if (c == '"' || c == '\\')
      (all += '\\') += static_cast<char>(c);
    else if (c < 0x20 || c == 0x7f)
      ((all += "\\x") += digits[c >> 4]) += digits[c & 15];
    else
      all += static_cast<char>(c);
  }
  return all + '"';
}

std::string in_quotes_where_needed(const std::string& text) {
  const bool plain = std::all_of(text.begin(), text.end(), [](unsigned char c) {
    return std::isalnum(c) || c == '.' || c == '_' || c == '-';
  });
  return plain && text.find('.') != text.npos &&
                 std::isalpha(static_cast<unsigned char>(text.front()))
             ? text
             : in_quotes(text);
}

std::optional<std::string> from_quotes(const std::string& text) {
  if (text.size() < 2 || text.front() != '"' || text.back() != '"') return std::nullopt;
  std::string all;
  for (std::size_t k = 1; k + 1 < text.size(); ++k) {
    if (text[k] == '"') return std::nullopt;
    if (text[k] != '\\') {
      all += text[k];
      continue;
    }
    if (++k + 1 >= text.size()) return std::nullopt;
    if (text[k] == '"' || text[k] == '\\') {
      all += text[k];
      continue;
    }
    if (text[k] != 'x' || k + 3 >= text.size() || digit(text[k + 1]) < 0 || digit(text[k + 2]) < 0)
      return std::nullopt;
    all += static_cast<char>(16 * digit(text[k + 1]) + digit(text[k + 2]));
    k += 2;
  }
  return all;
}

}  // namespace plumb
