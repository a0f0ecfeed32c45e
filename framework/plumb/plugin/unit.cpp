#include "plumb/plugin/unit.hpp"

#include <charconv>
#include <numbers>

namespace plumb {
namespace {

std::string written_in(const Unit& unit, double si) {
  // Rounding to 12 digits hides what the factor adds: 0.01 * 5 deg.
  char buffer[32];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, si / unit.factor,
                                 std::chars_format::general, 12)
                       .ptr;
  return std::string(buffer, end) + " " + unit.symbol;
}

}  // namespace

const char* name_of(Quantity quantity) {
  switch (quantity) {
    case Quantity::none:
      return "number";
    case Quantity::length:
      return "length";
    case Quantity::angle:
      return "angle";
    case Quantity::time:
      return "time";
    case Quantity::ratio:
      return "ratio";
    case Quantity::speed:
      return "speed";
    case Quantity::angular_speed:
      return "angular_speed";
    case Quantity::curvature:
      return "curvature";
    case Quantity::frequency:
      return "frequency";
  }
  return "?";
}

const char* si_symbol(Quantity quantity) {
  switch (quantity) {
    case Quantity::none:
      return "";
    case Quantity::length:
      return "m";
    case Quantity::angle:
      return "rad";
    case Quantity::time:
      return "s";
    case Quantity::ratio:
      return "";
    case Quantity::speed:
      return "m/s";
    case Quantity::angular_speed:
      return "rad/s";
    case Quantity::curvature:
      return "rad/m";
    case Quantity::frequency:
      return "Hz";
  }
  return "";
}

const std::vector<Unit>& units() {
  constexpr double degree = std::numbers::pi / 180.0;
  static const std::vector<Unit> all = {
      {Quantity::length, "m", 1},
      {Quantity::length, "cm", 0.01},
      {Quantity::length, "mm", 0.001},
      {Quantity::length, "km", 1000},
      {Quantity::angle, "deg", degree},
      {Quantity::angle, "rad", 1},
      {Quantity::time, "s", 1},
      {Quantity::time, "ms", 0.001},
      {Quantity::time, "min", 60},
      {Quantity::ratio, "%", 0.01},
      {Quantity::speed, "m/s", 1},
      {Quantity::speed, "km/h", 1 / 3.6},
      {Quantity::angular_speed, "deg/s", degree},
      {Quantity::angular_speed, "rad/s", 1},
      {Quantity::curvature, "deg/m", degree},
      {Quantity::curvature, "rad/m", 1},
      {Quantity::frequency, "Hz", 1},
  };
  return all;
}

const Unit* find_unit(std::string_view symbol) {
  for (const Unit& unit : units())
    if (symbol == unit.symbol) return &unit;
  return nullptr;
}

std::string known_units(Quantity quantity) {
  std::string text;
  for (const Unit& unit : units())
    if (unit.quantity == quantity) text += (text.empty() ? "" : ", ") + std::string(unit.symbol);
  return text;
}

std::string shortest(double value) {
  char buffer[32];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, value).ptr;
  return {buffer, end};
}

std::string written(double si, Quantity quantity) {
  std::string text;
  for (const Unit& unit : units()) {
    if (unit.quantity != quantity) continue;
    const std::string in_unit = written_in(unit, si);
    // The first unit listed is the one that people use, unless the number is odd there and round in
    // another: 0.001 rad.
    if (text.empty() || 2 * in_unit.size() <= text.size()) text = in_unit;
  }
  return text.empty() ? shortest(si) : text;
}

}  // namespace plumb
