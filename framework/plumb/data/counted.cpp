#include "plumb/data/counted.hpp"

#include <algorithm>

namespace plumb {
namespace {

/// "scan" of "scans", "match" of "matches", "entry" of "entries"; empty for what is no plural.
std::string singular_of(std::string_view word) {
  if (word == "series") return {};
  if (word.ends_with("ies") && word.size() > 4)
    return std::string(word.substr(0, word.size() - 3)) + "y";
  for (const std::string_view end : {"ches", "shes", "sses", "xes"})
    if (word.ends_with(end)) return std::string(word.substr(0, word.size() - 2));
  if (word.size() < 3 || !word.ends_with('s') || word.ends_with("ss") || word.ends_with("us"))
    return {};
  return std::string(word.substr(0, word.size() - 1));
}

}  // namespace

std::string counted(std::uint64_t n, std::string_view things) {
  std::string text = std::to_string(n) + " ";
  if (n != 1) return text.append(things);
  std::size_t begin = 0;
  for (int word = 0; word < 2 && begin < things.size(); ++word) {
    const std::size_t end = std::min(things.find_first_of(" ,:", begin), things.size());
    const std::string one = singular_of(things.substr(begin, end - begin));
    if (!one.empty())
      return text.append(things.substr(0, begin)).append(one).append(things.substr(end));
    begin = end + 1;
  }
  return text.append(things);
}

}  // namespace plumb
