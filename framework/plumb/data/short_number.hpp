#pragma once
/// Numbers as they stand in sentences for people.

#include <string>

namespace plumb {

/// Four significant digits, whole numbers from 1000 on: "0.2101", "42.36", "123457". What is no
/// number is "nan".
std::string short_number(double value);

}  // namespace plumb
