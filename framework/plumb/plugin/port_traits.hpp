#pragma once
/// How the members of a step's `In` and `Out` are read from the engine's ports and written to them.

#include <optional>
#include <utility>

#include "plumb/plugin/step.hpp"

namespace plumb {
/// How a member of an In looks at its wire: the type and the access of the port, and how the member
/// is filled. The specialisations are the list of what an In may hold; a module may add its own
/// (PartOf).
template <class Member>
struct InputTraits;
template <class T>
struct InputTraits<One<T>> {
  static constexpr Access access = Access::item;
  static const Type& type() { return type_of<T>(); }
  static void set(One<T>& to, const PortInput& from) { to = One<T>(from.one.template as<T>()); }
};
template <class T>
struct InputTraits<Ends<T>> {
  static constexpr Access access = Access::ends;
  static const Type& type() { return type_of<T>(); }
  static void set(Ends<T>& to, const PortInput& from) {
    to = {One<T>(from.one.template as<T>()), One<T>(from.other.template as<T>())};
  }
};
template <class T>
struct InputTraits<Each<T>> {
  static constexpr Access access = Access::each;
  static const Type& type() { return type_of<T>(); }
  static void set(Each<T>& to, const PortInput& from) { to = Each<T>(from.each); }
};
template <class T>
struct InputTraits<std::vector<Labelled<T>>> {
  static constexpr Access access = Access::several;
  static const Type& type() { return type_of<T>(); }
  static void set(Several<T>& to, const PortInput& from) {
    for (const auto& [label, value] : from.several)
      to.push_back({label, One<T>(value.template as<T>())});
  }
};

/// Base of the InputTraits of a member that sees, of one value T of the pipeline, what concerns its
/// item alone. Beside `set` they have
///   static constexpr const char* sees;                         for people
///   static SeenPart part(const T&, const ItemPlace&);          empty: nothing
/// and may have
///   static std::size_t ends_count(const T&);                   Step::ends_count
template <class T>
struct PartOf {
  using Whole = T;
  static constexpr Access access = Access::part;
  static const Type& type() { return type_of<T>(); }
};

namespace detail {

/// What the engine asks of an input that sees a part.
struct PartCode {
  SeenPart (*part)(const void* value, const ItemPlace& item) = nullptr;
  std::optional<std::size_t> (*ends_count)(const void* value) = nullptr;
};
template <class Traits>
PartCode part_code() {
  if constexpr (Traits::access == Access::part) {
    using T = typename Traits::Whole;
    return {[](const void* value, const ItemPlace& item) {
              return Traits::part(*static_cast<const T*>(value), item);
            },
            [](const void* value) -> std::optional<std::size_t> {
              if constexpr (requires(const T& whole) { Traits::ends_count(whole); })
                return Traits::ends_count(*static_cast<const T*>(value));
              (void)value;
              return std::nullopt;
            }};
  } else {
    return {};
  }
}

template <class T>
struct OutputTraits {
  static constexpr Emission emission = Emission::one;
  static const Type& type() { return type_of<T>(); }
  static void get(T& from, PortOutput& to) { to.one = any_value(std::move(from)); }
};
template <class T>
struct OutputTraits<std::vector<T>> {
  static constexpr Emission emission = Emission::many;
  static const Type& type() { return type_of<T>(); }
  static void get(std::vector<T>& from, PortOutput& to) {
    for (auto& value : from) to.many.push_back(any_value(std::move(value)));
  }
};
template <class T>
struct OutputTraits<Lazy<T>> {
  static constexpr Emission emission = Emission::lazy;
  static const Type& type() { return type_of<T>(); }
  static void get(Lazy<T>& from, PortOutput& to) {
    to.lazy.keys = std::move(from.keys);
    to.lazy.open = [open = std::move(from.open)](std::size_t k, Context& context) {
      return any_value(open(k, context));
    };
  }
};

}  // namespace detail

}  // namespace plumb
