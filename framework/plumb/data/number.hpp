#pragma once
/// A named number with its unit.

#include <string>
#include <vector>

#include "plumb/data/archive.hpp"

namespace plumb {

/// As in "rmse", 0.21, "m".
struct Number {
  std::string name;
  double value = 0;
  std::string unit;
};

template <class Archive, class T>
requires std::is_same_v<std::remove_const_t<T>, Number>
void fields(Archive& a, T& n) { a(n.name, n.value, n.unit); }

}  // namespace plumb
