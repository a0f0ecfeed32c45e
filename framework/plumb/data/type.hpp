#pragma once
/// The types of wires: name, version, grain, and how a value of unknown type is hashed, stored and
/// read.

#include <memory>
#include <string>

#include "plumb/data/values.hpp"

namespace plumb {

/// How many values of a type a run has: one, or one for each frame, segment or edge.
enum class Grain : std::uint8_t { whole, frame, segment, edge };
const char* name_of(Grain grain);

/// A type that may travel on a wire. There is one object per type, in libplumb: compare addresses.
struct Type {
  const char* name;
  int version;
  Grain grain;
  Hash128 (*hash)(const void* value);
  void (*write)(const void* value, OutArchive<TextSink>& to);
  std::shared_ptr<const void> (*read)(
      InArchive& from);                     ///< throws Error when the bytes end too early
  std::size_t (*bytes)(const void* value);  ///< how much memory it holds, about, with the search
                                            ///< trees that may be built on it
  const char* (*fault)(const void* value);  ///< "" or what no step may give: "a pose with a
                                            ///< non-finite number"
  std::shared_ptr<const void> (*empty)();   ///< a value without content: of Matches no pairs
};

/// The type of T, for every type that a port may have: type_of<Segment>().
template <class T>
const Type& type_of();
template <>
const Type& type_of<Trajectory>();
template <>
const Type& type_of<Frame>();
template <>
const Type& type_of<FrameRange>();
template <>
const Type& type_of<Segment>();
template <>
const Type& type_of<Descriptor>();
template <>
const Type& type_of<Features>();
template <>
const Type& type_of<Edges>();
template <>
const Type& type_of<Matches>();
template <>
const Type& type_of<Constraints>();
template <>
const Type& type_of<Poses>();
template <>
const Type& type_of<GridMap>();
template <>
const Type& type_of<Metrics>();
template <>
const Type& type_of<Document>();

/// The type with this name, or null.
const Type* find_type(std::string_view name);

/// A value of any type, shared and immutable.
struct AnyValue {
  const Type* type = nullptr;
  std::shared_ptr<const void> value;

  explicit operator bool() const { return value != nullptr; }
  template <class T>
  std::shared_ptr<const T> as() const {
    return std::static_pointer_cast<const T>(value);
  }
};

template <class T>
AnyValue any_value(T value) {
  return {&type_of<T>(), std::make_shared<const T>(std::move(value))};
}

}  // namespace plumb
