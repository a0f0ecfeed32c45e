#pragma once
/// The types of wires: name, version, item kind, and how a value of unknown type is hashed, stored
/// and read. Any module may define one.

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "plumb/data/archive.hpp"
#include "plumb/data/item_kind.hpp"
#include "plumb/data/number.hpp"

namespace plumb {

/// Of a type that lists the items of a kind.
struct ListCode {
  std::size_t (*size)(const void* list);
  /// Which two items of the kind `ends` item k joins.
  std::pair<std::size_t, std::size_t> (*ends)(const void* list, std::size_t k);
  std::size_t (*ends_count)(const void* list);  ///< how many items of the kind `ends` there are
};

/// What only the module that defines a type can do with its values. Functions that may be null say
/// so.
struct TypeCode {
  Hash128 (*hash)(const void* value);
  void (*write)(const void* value, OutArchive<TextSink>& to);
  /// Throws Error when the bytes end too early.
  std::shared_ptr<const void> (*read)(InArchive& from);
  /// How much memory it holds, about, with what may be built on it later (search trees).
  std::size_t (*bytes)(const void* value);
  /// "" or what no step may give: "a pose with a non-finite number".
  const char* (*fault)(const void* value);
  /// A value without content, as of matches no pairs. Null: there is none.
  std::shared_ptr<const void> (*empty)();
  /// The numbers that conditions may ask for. Null: it has none.
  const std::vector<Number>& (*numbers)(const void* value);
  /// Of a type that says which parts an item is made of: first .. end-1. Null for others.
  std::pair<std::size_t, std::size_t> (*range)(const void* value);
  const ListCode* list;  ///< Null unless it lists items.
};

/// A type that may travel on a wire. There is one object per type in a process: compare addresses.
/// All but `code` is known from a manifest.
struct Type {
  std::string name = {};
  int version = 1;
  const ItemKind* kind = nullptr;  ///< null: one value for the whole pipeline
  bool large = false;              ///< not worth keeping where only one step takes it: clouds
  bool has_numbers = false, has_empty = false;
  std::string layout = {};         ///< how a value lies in memory where `code` was compiled
  const TypeCode* code = nullptr;  ///< null as long as no module that defines it is loaded
};

/// Registers a type, which lives until the process ends; the type of that name if it is the same,
/// with its code from now on. Throws Error when another of that name is there: another version,
/// kind or layout.
const Type& define_type(const Type& type);

/// The type with this name, or null.
const Type* find_type(std::string_view name);

/// A type whose kind is meant by its name, as long as that is not registered.
struct TypeDraft {
  Type type = {};                        ///< its kind is not looked at
  std::optional<std::string> kind = {};  ///< none: one value for the whole pipeline
};

/// Registers kinds and types together, as define_kind and define_type do; or, with an Error, none
/// of them: one is there already and is another one, or a type is of a kind that is neither there
/// nor among these.
void define_together(const std::vector<ItemKind>& kinds, const std::vector<TypeDraft>& types);

/// How a C++ type becomes a type of wires. A specialisation beside the type has
///   static constexpr const char* name;           registered: "Segment"
///   static constexpr int version;                raised when its fields change
/// and may have
///   static const ItemKind& kind();               one value for each such item
///   static constexpr bool large = true;
///   static const char* fault(const T&);          see TypeCode
///   static T empty();
///   static const std::vector<Number>& numbers(const T&);
///   static std::size_t extra_bytes(const T&);    what may be built on it later
///   static std::pair<std::size_t, std::size_t> range(const T&);
///   static std::size_t size(const T&), ends_count(const T&);           of a list of items
///   static std::pair<std::size_t, std::size_t> ends(const T&, std::size_t k);
///   static std::string layout();                 what its memory depends on beside its size
/// Its fields are listed once, by `fields(archive, value)` (archive.hpp), in its own namespace.
template <class T>
struct TypeTraits;

namespace detail {

struct CountSink {
  std::size_t size = 0;
  void put(const void*, std::size_t n) { size += n; }
};

template <class T>
const T& as(const void* value) {
  return *static_cast<const T*>(value);
}

template <class T>
std::size_t bytes_of(const void* value) {
  OutArchive<CountSink> archive;
  archive(as<T>(value));
  if constexpr (requires { TypeTraits<T>::extra_bytes(as<T>(value)); })
    return archive.size + TypeTraits<T>::extra_bytes(as<T>(value));
  return archive.size;
}

template <class T>
const ListCode* list_code() {
  using Traits = TypeTraits<T>;
  if constexpr (requires(const T& list) { Traits::ends(list, 0); }) {
    static constexpr ListCode code = {
        [](const void* list) { return Traits::size(as<T>(list)); },
        [](const void* list, std::size_t k) { return Traits::ends(as<T>(list), k); },
        [](const void* list) { return Traits::ends_count(as<T>(list)); }};
    return &code;
  } else {
    return nullptr;
  }
}

template <class T>
const TypeCode& type_code() {
  using Traits = TypeTraits<T>;
  static const TypeCode code = [] {
    TypeCode c{};
    c.hash = [](const void* value) { return content_hash(as<T>(value)); };
    c.write = [](const void* value, OutArchive<TextSink>& to) { to(as<T>(value)); };
    c.read = [](InArchive& from) -> std::shared_ptr<const void> {
      auto value = std::make_shared<T>();
      from(*value);
      return value;
    };
    c.bytes = &bytes_of<T>;
    c.fault = [](const void* value) -> const char* {
      if constexpr (requires { Traits::fault(as<T>(value)); }) return Traits::fault(as<T>(value));
      (void)value;
      return "";
    };
    if constexpr (requires { Traits::empty(); })
      c.empty = []() -> std::shared_ptr<const void> {
        return std::make_shared<const T>(Traits::empty());
      };
    if constexpr (requires(const T& value) { Traits::numbers(value); })
      c.numbers = [](const void* value) -> const std::vector<Number>& {
        return Traits::numbers(as<T>(value));
      };
    if constexpr (requires(const T& value) { Traits::range(value); })
      c.range = [](const void* value) { return Traits::range(as<T>(value)); };
    c.list = list_code<T>();
    return c;
  }();
  return code;
}

template <class T>
Type described_type() {
  using Traits = TypeTraits<T>;
  Type type;
  type.name = Traits::name;
  type.version = Traits::version;
  if constexpr (requires { Traits::kind(); }) type.kind = &define_kind(Traits::kind());
  if constexpr (requires { Traits::large; }) type.large = Traits::large;
  type.layout = std::to_string(sizeof(T)) + "/" + std::to_string(alignof(T));
  if constexpr (requires { Traits::layout(); }) type.layout += ", " + Traits::layout();
  type.code = &type_code<T>();
  type.has_numbers = type.code->numbers != nullptr;
  type.has_empty = type.code->empty != nullptr;
  return type;
}

}  // namespace detail

/// The type of T, which is registered when it is first asked for: type_of<Segment>().
template <class T>
const Type& type_of() {
  static const Type& type = define_type(detail::described_type<T>());
  return type;
}

/// A value of any type, shared and immutable.
struct AnyValue {
  const Type* type = nullptr;
  std::shared_ptr<const void> value;

  explicit operator bool() const { return value != nullptr; }
  template <class T>
  std::shared_ptr<const T> as() const {
    return std::static_pointer_cast<const T>(value);
  }
  Hash128 hash() const { return type->code->hash(value.get()); }
};

template <class T>
AnyValue any_value(T value) {
  return {&type_of<T>(), std::make_shared<const T>(std::move(value))};
}

}  // namespace plumb
