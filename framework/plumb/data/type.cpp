#include "plumb/data/type.hpp"

#include <deque>
#include <mutex>

#include "plumb/data/error.hpp"

namespace plumb {
namespace {

/// What is registered in this process. Addresses stay.
struct Registered {
  std::mutex mutex;
  std::deque<ItemKind> kinds;
  std::deque<Type> types;
};
Registered& registered() {
  static Registered all;
  return all;
}

template <class List>
auto* named(List& list, std::string_view name) {
  for (auto& one : list)
    if (one.name == name) return &one;
  return static_cast<decltype(&list.front())>(nullptr);
}

std::string described(const ItemKind* kind) {
  return kind ? "one per " + kind->name : std::string("one for the whole pipeline");
}

/// What two definitions of a type differ in; "" where one serves both.
std::string difference(const Type& there, const Type& other) {
  const auto differs = [](const std::string& what, const auto& a, const auto& b) {
    return "its " + what + " is " + a + " there and " + b + " here";
  };
  if (there.version != other.version)
    return differs("version", std::to_string(there.version), std::to_string(other.version));
  if (there.kind != other.kind)
    return differs("grain", described(there.kind), described(other.kind));
  if (there.large != other.large || there.has_numbers != other.has_numbers ||
      there.has_empty != other.has_empty)
    return "its traits are others there than here";
  if (!there.layout.empty() && !other.layout.empty() && there.layout != other.layout)
    return differs("layout in memory", there.layout, other.layout);
  return "";
}

}  // namespace

const ItemKind& define_kind(const ItemKind& kind) {
  Registered& all = registered();
  const std::lock_guard lock(all.mutex);
  const ItemKind* there = named(all.kinds, kind.name);
  if (!there) return all.kinds.emplace_back(kind);
  if (*there != kind)
    throw Error("item kind '" + kind.name +
                "' is defined twice, and not alike; give one of the two another name");
  return *there;
}

const ItemKind* find_kind(std::string_view name) {
  Registered& all = registered();
  const std::lock_guard lock(all.mutex);
  return named(all.kinds, name);
}

const Type& define_type(const Type& type) {
  Registered& all = registered();
  const std::lock_guard lock(all.mutex);
  Type* there = named(all.types, type.name);
  if (!there) return all.types.emplace_back(type);
  if (const std::string why = difference(*there, type); !why.empty())
    throw Error("type '" + type.name + "' is defined twice, and not alike: " + why +
                "; build both modules with the same header, or give one of the types another name");
  if (!there->code) there->code = type.code;
  if (there->layout.empty()) there->layout = type.layout;
  return *there;
}

const Type* find_type(std::string_view name) {
  Registered& all = registered();
  const std::lock_guard lock(all.mutex);
  return named(all.types, name);
}

}  // namespace plumb
