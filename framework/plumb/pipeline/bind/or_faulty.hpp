#pragma once
/// The one way in which a stage says that something is wrong.

#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

namespace plumb::pipeline {

/// Stands in the place of what is wrong. The mistake was told where it was found; who comes across
/// this says nothing more of it.
struct Faulty {};

/// A `T`, or what is faulty.
template <class T>
class OrFaulty {
 public:
  OrFaulty(Faulty) {}
  OrFaulty(T value) : value_(std::move(value)) {}

  explicit operator bool() const { return value_.has_value(); }
  const T& operator*() const { return *value_; }
  const T* operator->() const { return &*value_; }
  /// For those who come when all mistakes were told: throws std::logic_error when it is faulty.
  const T& value() const {
    if (!value_) throw std::logic_error("a faulty part of a pipeline has no value");
    return *value_;
  }

 private:
  std::optional<T> value_;
};

/// The values of all, as value() gives them.
template <class T>
std::vector<T> values_of(const std::vector<OrFaulty<T>>& parts) {
  std::vector<T> values;
  values.reserve(parts.size());
  for (const OrFaulty<T>& part : parts) values.push_back(part.value());
  return values;
}

}  // namespace plumb::pipeline
