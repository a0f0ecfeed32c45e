#include "plumb/plugin/licence.hpp"

#include <algorithm>
#include <string_view>
#include <utility>
#include <vector>

namespace plumb {
namespace {

/// SPDX's short names of what libraries of the field come under.
constexpr std::string_view licences[] = {
    "0BSD",
    "AGPL-3.0-only",
    "AGPL-3.0-or-later",
    "Apache-2.0",
    "BSD-2-Clause",
    "BSD-3-Clause",
    "BSL-1.0",
    "CC-BY-4.0",
    "CC-BY-NC-4.0",
    "CC-BY-NC-SA-4.0",
    "CC-BY-SA-4.0",
    "CC0-1.0",
    "CECILL-2.1",
    "EPL-2.0",
    "EUPL-1.2",
    "GPL-2.0-only",
    "GPL-2.0-or-later",
    "GPL-3.0-only",
    "GPL-3.0-or-later",
    "ISC",
    "LGPL-2.1-only",
    "LGPL-2.1-or-later",
    "LGPL-3.0-only",
    "LGPL-3.0-or-later",
    "MIT",
    "MPL-2.0",
    "NCSA",
    "Unlicense",
    "Zlib",
    "bzip2-1.0.6",
    "libpng-2.0",
};
constexpr std::string_view exceptions[] = {"Classpath-exception-2.0", "GCC-exception-3.1",
                                           "LLVM-exception"};
constexpr std::string_view other = "LicenseRef-";  // and a name: SPDX's form for all the rest

template <std::size_t N>
bool holds(const std::string_view (&list)[N], std::string_view word) {
  return std::find(std::begin(list), std::end(list), word) != std::end(list);
}

template <std::size_t N>
std::string listed(const std::string_view (&list)[N]) {
  std::string text;
  for (const std::string_view name : list) text += (text.empty() ? "" : ", ") + std::string(name);
  return text;
}

bool is_licence(std::string_view word) {
  if (!word.starts_with(other)) return holds(licences, word);
  word.remove_prefix(other.size());
  return !word.empty() && std::all_of(word.begin(), word.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
           c == '.';
  });
}

bool is_operator(std::string_view word) {
  return word == "AND" || word == "OR" || word == "WITH" || word == ")";
}

/// Its words and parentheses.
std::vector<std::string> words_of(const std::string& expression) {
  std::vector<std::string> words;
  std::string word;
  for (const char c : expression + " ") {
    if (c != ' ' && c != '(' && c != ')') {
      word += c;
      continue;
    }
    if (!word.empty()) words.push_back(std::exchange(word, ""));
    if (c != ' ') words.emplace_back(1, c);
  }
  return words;
}

/// SPDX's grammar, word by word: without recursion, so that no text nests too deep for the stack.
class Grammar {
 public:
  /// "" or what is wrong with the next word.
  std::string take(const std::string& word) {
    switch (awaited_) {
      case Awaited::licence:
        return take_licence(word);
      case Awaited::exception:
        awaited_ = Awaited::junction;
        return holds(exceptions, word)
                   ? ""
                   : "names the exception '" + word + "', which is not known here; known are " +
                         listed(exceptions);
      case Awaited::junction:
        return take_junction(word);
    }
    return "";
  }
  /// "" or what is missing when there are no more words.
  std::string end() const {
    if (awaited_ != Awaited::junction) return "ends where something must follow";
    return open_ > 0 ? "lacks a ')'" : "";
  }

 private:
  enum class Awaited { licence, exception, junction };

  std::string take_licence(const std::string& word) {
    if (word == "(") {
      ++open_;
      return "";
    }
    if (is_operator(word)) return "has no licence before '" + word + "'";
    if (!is_licence(word))
      return "names '" + word + "', which is not known here; known are " + listed(licences) +
             ", and any other is written " + std::string(other) + "NAME";
    awaited_ = Awaited::junction;
    takes_exception_ = true;
    return "";
  }

  std::string take_junction(const std::string& word) {
    if (word == ")" && open_ > 0)
      --open_;
    else if (word == "AND" || word == "OR")
      awaited_ = Awaited::licence;
    else if (word == "WITH" && takes_exception_)
      awaited_ = Awaited::exception;
    else
      return "has '" + word + "' where AND or OR is expected";
    takes_exception_ = false;
    return "";
  }

  Awaited awaited_ = Awaited::licence;
  bool takes_exception_ = false;  ///< the last word was a licence
  std::size_t open_ = 0;          ///< parentheses
};

}  // namespace

std::string fault_of_licence(const std::string& expression) {
  const std::vector<std::string> words = words_of(expression);
  if (words.empty())
    return "its licence is empty; write an SPDX expression, such as BSD-3-Clause, or leave it out";
  Grammar grammar;
  std::string fault;
  for (const std::string& word : words)
    if (fault = grammar.take(word); !fault.empty()) break;
  if (fault.empty()) fault = grammar.end();
  return fault.empty() ? "" : "its licence '" + expression + "' " + fault;
}

}  // namespace plumb
