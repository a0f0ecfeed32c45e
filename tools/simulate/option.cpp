#include "simulate/option.hpp"

#include <charconv>
#include <cmath>

#include "plumb/data/error.hpp"

namespace plumb::simulate {
namespace {

/// The number at the start of `text`, which is cut off it together with the blanks behind.
double take_number(std::string& text, const std::string& place) {
  double value = 0;
  const char* begin = text.data() + (text.starts_with('+') ? 1 : 0);
  const auto [end, error] = std::from_chars(begin, text.data() + text.size(), value);
  if (error != std::errc() || !std::isfinite(value))
    throw Error(place + ": '" + text + "' is not a number; write for example 2.5");
  text.erase(0, static_cast<std::size_t>(end - text.data()));
  text.erase(0, text.find_first_not_of(' ') == std::string::npos ? text.size()
                                                                 : text.find_first_not_of(' '));
  return value;
}

}  // namespace

double parse_quantity(const OptionRange& option, std::string text, bool bare_is_si,
                      const std::string& place) {
  const std::string whole = text;
  double value = take_number(text, place);
  const bool wants_unit = option.quantity != Quantity::none;
  if (text.empty() && wants_unit && !bare_is_si)
    throw Error(place + ": '" + whole +
                "' lacks its unit; write one of: " + known_units(option.quantity));
  if (!text.empty()) {
    const Unit* unit = find_unit(text);
    if (!wants_unit || !unit || unit->quantity != option.quantity)
      throw Error(place + ": '" + whole + "' ends in '" + text + "'; " +
                  (wants_unit ? "write one of: " + known_units(option.quantity)
                              : "write a number without unit"));
    value *= unit->factor;
  }
  if (value < option.low || value > option.high)
    throw Error(place + ": " + whole + " is out of range; allowed is " +
                written(option.low, option.quantity) + " to " +
                written(option.high, option.quantity));
  return value;
}

std::int64_t parse_whole(const OptionRange& option, const std::string& text,
                         const std::string& place) {
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size())
    throw Error(place + ": '" + text + "' is not a whole number; write for example 64");
  if (static_cast<double>(value) < option.low || static_cast<double>(value) > option.high)
    throw Error(place + ": " + text + " is out of range; allowed is " + shortest(option.low) +
                " to " + shortest(option.high));
  return value;
}

std::string exactly(double value, const OptionRange& option) {
  if (option.quantity == Quantity::none) return shortest(value);
  const std::string text = written(value, option.quantity);
  if (parse_quantity(option, text, false, option.key) == value) return text;
  return shortest(value) + " " + si_symbol(option.quantity);
}

}  // namespace plumb::simulate
