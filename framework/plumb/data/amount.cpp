#include "plumb/data/amount.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <span>

#include "plumb/data/error.hpp"

namespace plumb {
namespace {

struct Unit {
  const char* symbol;
  double factor;
};

constexpr double kibi = 1024;
constexpr std::array<Unit, 9> sizes = {{{"B", 1},
                                        {"kB", 1e3},
                                        {"MB", 1e6},
                                        {"GB", 1e9},
                                        {"TB", 1e12},
                                        {"KiB", kibi},
                                        {"MiB", kibi* kibi},
                                        {"GiB", kibi* kibi* kibi},
                                        {"TiB", kibi* kibi* kibi* kibi}}};
constexpr std::array<Unit, 5> ages = {
    {{"s", 1}, {"min", 60}, {"h", 3600}, {"d", 86400}, {"w", 7 * 86400}}};

/// A number that is not negative and its unit, with or without a blank between them.
double amount(const std::string& option, const std::string& text, std::span<const Unit> units,
              const char* example) {
  double number = 0;
  const char* const end = text.data() + text.size();
  const auto read = std::from_chars(text.data(), end, number);
  std::string symbol(read.ptr, end);
  symbol.erase(0, symbol.find_first_not_of(' '));
  std::string known;
  for (const Unit& unit : units) {
    if (read.ec == std::errc() && number >= 0 && number * unit.factor < 9e15 &&
        symbol == unit.symbol)
      return number * unit.factor;
    known += (known.empty() ? "" : ", ") + std::string(unit.symbol);
  }
  throw Error(option + " " + text + ": is not an amount; give a number and one of " + known +
              ", as in " + example);
}

}  // namespace

std::uint64_t bytes_of_text(const std::string& option, const std::string& text) {
  return static_cast<std::uint64_t>(std::llround(amount(option, text, sizes, "10GiB")));
}

std::chrono::milliseconds age_of_text(const std::string& option, const std::string& text) {
  return std::chrono::milliseconds(
      std::llround(std::min(1e3 * amount(option, text, ages, "30d"), 9e15)));
}

std::string text_of_bytes(std::uint64_t bytes) {
  double size = static_cast<double>(bytes);
  const char* unit = "B";
  for (const char* larger : {"KiB", "MiB", "GiB", "TiB"}) {
    if (size < 1000) break;
    size /= kibi;
    unit = larger;
  }
  char text[32];
  std::snprintf(text, sizeof text, size < 10 && *unit != 'B' ? "%.1f %s" : "%.0f %s", size, unit);
  return text;
}

}  // namespace plumb
