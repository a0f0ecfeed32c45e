#pragma once
/// From the C++ type of a parameter to what is said of it, and its values there and back.

#include <filesystem>
#include <limits>
#include <optional>
#include <type_traits>

#include "plumb/plugin/description.hpp"

namespace plumb::detail {

template <class T>
struct is_optional : std::false_type {};
template <class T>
struct is_optional<std::optional<T>> : std::true_type {};

template <class T>
ParameterValue to_value(const T& v) {
  if constexpr (std::is_same_v<T, bool>)
    return v;
  else if constexpr (std::is_integral_v<T>)
    return static_cast<std::int64_t>(v);
  else if constexpr (std::is_floating_point_v<T>)
    return static_cast<double>(v);
  else if constexpr (std::is_same_v<T, std::filesystem::path>)
    return v.string();
  else
    return std::string(v);
}

template <class T>
T from_value(const ParameterValue& v) {
  if constexpr (std::is_same_v<T, bool>)
    return std::get<bool>(v);
  else if constexpr (std::is_integral_v<T>)
    return static_cast<T>(std::get<std::int64_t>(v));
  else if constexpr (std::is_floating_point_v<T>)
    return static_cast<T>(std::get<double>(v));
  else
    return T(std::get<std::string>(v));
}

/// A parameter of type T: its kind, and the bounds that the type has.
template <class T>
ParameterDescription description_of(const char* parameter) {
  ParameterDescription p;
  p.name = parameter;
  p.low = -std::numeric_limits<double>::infinity();
  p.high = std::numeric_limits<double>::infinity();
  if constexpr (std::is_same_v<T, bool>)
    p.kind = ParameterKind::boolean;
  else if constexpr (std::is_integral_v<T>)
    p.kind = ParameterKind::integer;
  else if constexpr (std::is_floating_point_v<T>)
    p.kind = ParameterKind::number;
  else if constexpr (std::is_same_v<T, std::filesystem::path>)
    p.kind = ParameterKind::path;
  else
    p.kind = ParameterKind::text;
  if constexpr (std::is_unsigned_v<T> && !std::is_same_v<T, bool>) p.low = 0;
  if constexpr (std::is_integral_v<T> && !std::is_same_v<T, bool> && sizeof(T) <= 4)
    p.high = static_cast<double>(std::numeric_limits<T>::max());
  return p;
}

}  // namespace plumb::detail
