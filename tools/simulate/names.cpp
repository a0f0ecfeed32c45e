#include "simulate/names.hpp"

#include <algorithm>
#include <numeric>

namespace plumb::simulate {
namespace {

/// Letters to insert, delete or replace (Levenshtein).
std::size_t edits(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, row[j + 1] + 1});
    }
  }
  return row.back();
}

}  // namespace

std::string suggestion(const std::string& wrong, const std::vector<std::string>& known) {
  std::string list, nearest;
  std::size_t fewest = wrong.size() / 3 + 2;
  for (const std::string& name : known) {
    list += (list.empty() ? "" : ", ") + name;
    if (const std::size_t n = edits(wrong, name); n < fewest) fewest = n, nearest = name;
  }
  return (nearest.empty() ? "" : "did you mean '" + nearest + "'? ") + ("known: " + list);
}

}  // namespace plumb::simulate
