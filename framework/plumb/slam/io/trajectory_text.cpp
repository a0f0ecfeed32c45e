#include "plumb/slam/io/trajectory_text.hpp"

#include <charconv>
#include <cmath>

#include "plumb/data/counted.hpp"

namespace plumb::io {

bool next_numbers(const std::filesystem::path& file, Lines& lines, char also,
                  std::span<double> values) {
  std::string_view line;
  while (lines.next(line)) {
    line = line.substr(0, line.find('#'));
    std::size_t count = 0;
    for (auto word = next_word(line, also); !word.empty(); word = next_word(line, also), ++count) {
      double value = 0;
      if (!to_number(word, value) || !std::isfinite(value))
        refuse(file, lines.number(),
               in_quotes(word) + " is not a finite number: correct it or leave the line out");
      if (count < values.size()) values[count] = value;
    }
    if (count == 0) continue;
    if (count != values.size())
      refuse(file, lines.number(),
             "has " + counted(count, "numbers") + " where " + std::to_string(values.size()) +
                 " belong: correct the line");
    return true;
  }
  return false;
}

void require_later(const std::filesystem::path& file, std::size_t line,
                   const std::vector<double>& stamps, double stamp) {
  if (!stamps.empty() && !(stamp > stamps.back()))
    refuse(file, line,
           "the stamp " + fixed(stamp, 6) + " is not later than the one before, " +
               fixed(stamps.back(), 6) + ": sort the lines by time and leave doubles out");
}

std::string fixed(double value, int decimals) {
  char buffer[400];  // the largest double has 309 digits before its point
  const auto end =
      std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::fixed, decimals).ptr;
  return {buffer, end};
}

}  // namespace plumb::io
