#pragma once
/// What the trajectory readers and writers share: lines of numbers.

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "plumb/data/io/file_text.hpp"

namespace plumb::io {

/// Reads the next line that is neither blank nor a comment (#) into `values`; numbers are parted by
/// blanks or `also`. False at the end. Throws Error with file:line: another number of words, text
/// that is no number, NaN, infinite.
bool next_numbers(const std::filesystem::path& file, Lines& lines, char also,
                  std::span<double> values);

/// Throws Error with file:line unless `stamp` is later than the last of `stamps`.
void require_later(const std::filesystem::path& file, std::size_t line,
                   const std::vector<double>& stamps, double stamp);

/// `value` with so many decimals, whatever the locale.
std::string fixed(double value, int decimals);

}  // namespace plumb::io
