#include "plumb/data/type.hpp"

#include <map>
#include <mutex>

#include "plumb/data/error.hpp"

namespace plumb {
namespace {

template <class T>
using ByName = std::map<std::string, T, std::less<>>;

/// What is registered in this process. Addresses stay.
struct Registered {
  std::mutex mutex;
  ByName<ItemKind> kinds;
  ByName<Type> types;
};
Registered& registered() {
  static Registered all;
  return all;
}

template <class T>
const T* named(const ByName<T>& all, std::string_view name) {
  const auto at = all.find(name);
  return at == all.end() ? nullptr : &at->second;
}

/// Of what is registered, else of what is about to be.
template <class T>
const T* named(const ByName<T>& all, const ByName<T>& fresh, std::string_view name) {
  const T* there = named(all, name);
  return there ? there : named(fresh, name);
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

void require_same(const ItemKind& there, const ItemKind& other) {
  if (there != other)
    throw Error("item kind '" + other.name +
                "' is defined twice, and not alike; give one of the two another name");
}

void require_same(const Type& there, const Type& other) {
  if (const std::string why = difference(there, other); !why.empty())
    throw Error("type '" + other.name + "' is defined twice, and not alike: " + why +
                "; build both modules with the same header, or give one of the types another name");
}

/// Registers what fits what is there.
const Type& take(Registered& all, const Type& type) {
  Type& there = all.types.try_emplace(type.name, type).first->second;
  if (!there.code) there.code = type.code;
  if (there.layout.empty()) there.layout = type.layout;
  return there;
}

}  // namespace

const ItemKind& define_kind(const ItemKind& kind) {
  Registered& all = registered();
  const std::lock_guard lock(all.mutex);
  const ItemKind& there = all.kinds.try_emplace(kind.name, kind).first->second;
  require_same(there, kind);
  return there;
}

const ItemKind* find_kind(std::string_view name) {
  Registered& all = registered();
  const std::lock_guard lock(all.mutex);
  return named(all.kinds, name);
}

const Type& define_type(const Type& type) {
  Registered& all = registered();
  const std::lock_guard lock(all.mutex);
  if (const Type* there = named(all.types, type.name)) require_same(*there, type);
  return take(all, type);
}

const Type* find_type(std::string_view name) {
  Registered& all = registered();
  const std::lock_guard lock(all.mutex);
  return named(all.types, name);
}

void define_together(const std::vector<ItemKind>& kinds, const std::vector<TypeDraft>& types) {
  Registered& all = registered();
  const std::lock_guard lock(all.mutex);
  ByName<ItemKind> fresh_kinds;
  for (const ItemKind& kind : kinds)
    if (const ItemKind* there = named(all.kinds, fresh_kinds, kind.name))
      require_same(*there, kind);
    else
      fresh_kinds.emplace(kind.name, kind);
  ByName<Type> fresh;  // of fresh kinds, as yet
  for (const TypeDraft& draft : types) {
    Type type = draft.type;
    type.kind = draft.kind ? named(all.kinds, fresh_kinds, *draft.kind) : nullptr;
    if (draft.kind && !type.kind)
      throw Error("item kind '" + *draft.kind + "' is named and not defined");
    if (const Type* there = named(all.types, fresh, type.name)) require_same(*there, type);
    fresh.emplace(type.name, type);
  }
  all.kinds.insert(fresh_kinds.begin(), fresh_kinds.end());
  for (auto& [name, type] : fresh) {
    if (type.kind) type.kind = named(all.kinds, type.kind->name);
    take(all, type);
  }
}

}  // namespace plumb
