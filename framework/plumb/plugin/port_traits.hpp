#pragma once
/// How the members of a step's `In` and `Out` are read from the engine's ports and written to them.

#include <utility>

#include "plumb/plugin/step.hpp"

namespace plumb {
namespace detail {

/// Reads an input member from a PortInput; its specialisations are the list of what an In may hold.
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
template <>
struct InputTraits<Relative> {
  static constexpr Access access = Access::relative;
  static const Type& type() { return type_of<Poses>(); }
  static void set(Relative& to, const PortInput& from) { to = {from.T_i_j, from.wired}; }
};
template <>
struct InputTraits<OverEdges> {
  static constexpr Access access = Access::over_edges;
  static const Type& type() { return type_of<Edges>(); }
  static void set(OverEdges& to, const PortInput& from) { to = {from.wired}; }
};
template <>
struct InputTraits<ThisEdge> {
  static constexpr Access access = Access::this_edge;
  static const Type& type() { return type_of<Edges>(); }
  static void set(ThisEdge& to, const PortInput& from) { to = {from.edge, from.wired}; }
};

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
