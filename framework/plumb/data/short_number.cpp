#include "plumb/data/short_number.hpp"

#include <charconv>
#include <cmath>

namespace plumb {

std::string short_number(double value) {
  if (std::isnan(value)) return "nan";  // without the sign that it may have
  constexpr double largest = 1e12;      // from here on digits are harder to read than an exponent
  const bool whole = std::abs(value) >= 1000 && std::abs(value) < largest;
  char buffer[32];
  const auto end =
      whole
          ? std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::fixed, 0).ptr
          : std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::general, 4).ptr;
  return {buffer, end};
}

}  // namespace plumb
