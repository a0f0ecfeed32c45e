#pragma once
/// Options of a scene: declared once for the command line, the scene files and their checks.

#include <cstdint>
#include <optional>
#include <string>
#include <type_traits>
#include <variant>

#include "plumb/plugin/unit.hpp"

namespace plumb::simulate {

/// What a value of an option may be, SI, both ends allowed.
struct OptionRange {
  const char* key;
  const char* about;
  Quantity quantity = Quantity::none;
  double low = 0, high = 0;
};

/// One option of a scene S, and the member that it sets.
template <class S>
struct OptionOf : OptionRange {
  using Field = std::variant<std::string S::*, std::int64_t S::*, std::optional<std::int64_t> S::*,
                             double S::*, std::optional<double> S::*>;
  Field field;

  OptionOf(const char* key_, const char* about_, Quantity quantity_, double low_, double high_,
           Field field_)
      : OptionRange{key_, about_, quantity_, low_, high_}, field(field_) {}
};

/// The number in `text`, SI. A quantity without its unit is in SI if `bare_is_si`, else refused.
/// Throws Error, which begins with `place`, for what is not a number, out of range or in a unit of
/// something else.
double parse_quantity(const OptionRange& option, std::string text, bool bare_is_si,
                      const std::string& place);

/// The whole number in `text`. Throws Error as parse_quantity.
std::int64_t parse_whole(const OptionRange& option, const std::string& text,
                         const std::string& place);

/// The text with a unit that reads back as the same double.
std::string exactly(double value, const OptionRange& option);

template <class T>
constexpr bool is_real = std::is_same_v<T, double> || std::is_same_v<T, std::optional<double>>;

/// Sets the option of `scene` from text. Throws Error as parse_quantity.
template <class S>
void set_option(S& scene, const OptionOf<S>& option, const std::string& text, bool bare_is_si,
                const std::string& place) {
  const auto into = [&](auto member) {
    auto& value = scene.*member;
    using T = std::decay_t<decltype(value)>;
    if constexpr (std::is_same_v<T, std::string>)
      value = text;
    else if constexpr (is_real<T>)
      value = parse_quantity(option, text, bare_is_si, place);
    else
      value = parse_whole(option, text, place);
  };
  std::visit(into, option.field);
}

/// The value of the option as a scene file has it; none where it is not given.
template <class S>
std::optional<std::string> option_text(const S& scene, const OptionOf<S>& option) {
  const auto write = [&](auto member) -> std::optional<std::string> {
    const auto& value = scene.*member;
    using T = std::decay_t<decltype(value)>;
    if constexpr (std::is_same_v<T, std::string>)
      return value;
    else if constexpr (std::is_same_v<T, double>)
      return exactly(value, option);
    else if constexpr (std::is_same_v<T, std::int64_t>)
      return std::to_string(value);
    else if (!value)
      return std::nullopt;
    else if constexpr (std::is_same_v<T, std::optional<double>>)
      return exactly(*value, option);
    else
      return std::to_string(*value);
  };
  return std::visit(write, option.field);
}

}  // namespace plumb::simulate
