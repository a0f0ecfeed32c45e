#pragma once
/// Units of parameters: a quantity in YAML carries its unit, in C++ it is SI.

#include <string>
#include <string_view>
#include <vector>

namespace plumb {

/// What a number measures. `none` takes a bare number; every other wants its unit.
enum class Quantity {
  none,
  length,
  angle,
  time,
  ratio,
  speed,
  angular_speed,
  curvature,
  frequency
};

/// One way to write a quantity: `value_si = factor * value`.
struct Unit {
  Quantity quantity;
  const char* symbol;
  double factor;
};

const char* name_of(Quantity quantity);    ///< "length"
const char* si_symbol(Quantity quantity);  ///< "m"; "" for none
const std::vector<Unit>& units();          ///< all that are known
const Unit* find_unit(std::string_view symbol);
std::string known_units(Quantity quantity);  ///< "m, cm, mm, km"

/// A value in SI as people write it: 0.3 -> "0.3 m", an angle in degrees, a ratio in percent; in
/// another unit where that is half as long: 0.001 -> "0.001 rad", not "0.0572957795131 deg".
std::string written(double si, Quantity quantity);

/// The shortest decimal text that reads back as the same double.
std::string shortest(double value);

}  // namespace plumb
