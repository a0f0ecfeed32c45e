#pragma once
/// Value types and item kinds of two modules that know the core's SDK alone: trees, and pairs of
/// neighbours among them.

#include <cmath>

#include "plumb/plugin/module.hpp"

namespace forest {

/// One tree: where it stands along a row [m], and how high it is [m].
struct Tree {
  double place = 0, height = 0;
};
template <class Archive, class T>
requires std::is_same_v<std::remove_const_t<T>, Tree>
void fields(Archive& a, T& tree) { a(tree.place, tree.height); }

/// Which trees are neighbours: pairs of their numbers.
struct Pairs {
  std::uint32_t trees = 0;
  std::vector<std::uint32_t> first, second;
};
template <class Archive, class T>
requires std::is_same_v<std::remove_const_t<T>, Pairs>
void fields(Archive& a, T& pairs) { a(pairs.trees, pairs.first, pairs.second); }

/// How far apart two neighbours stand [m].
struct Gap {
  double metres = 0;
};
template <class Archive, class T>
requires std::is_same_v<std::remove_const_t<T>, Gap>
void fields(Archive& a, T& gap) { a(gap.metres); }

/// Named numbers.
struct Tally {
  std::vector<plumb::Number> numbers;
};
template <class Archive, class T>
requires std::is_same_v<std::remove_const_t<T>, Tally>
void fields(Archive& a, T& tally) { a(tally.numbers); }

inline const plumb::ItemKind& tree_kind() {
  static const plumb::ItemKind kind = {.name = "tree"};
  return kind;
}
inline const plumb::ItemKind& pair_kind() {
  static const plumb::ItemKind kind = {.name = "pair", .ends = "tree", .list = "forest.Pairs"};
  return kind;
}
using TreeStep = plumb::ItemStep<&tree_kind>;
using PairStep = plumb::ItemStep<&pair_kind>;

/// In a PairStep: which pairs there are.
struct OverPairs {};

}  // namespace forest

template <>
struct plumb::TypeTraits<forest::Tree> {
  static constexpr const char* name = "forest.Tree";
  static constexpr int version = 1;
  static const ItemKind& kind() { return forest::tree_kind(); }
  static const char* fault(const forest::Tree& tree) {
    return std::isfinite(tree.place) && std::isfinite(tree.height) ? "" : "a tree without a place";
  }
};
template <>
struct plumb::TypeTraits<forest::Pairs> {
  static constexpr const char* name = "forest.Pairs";
  static constexpr int version = 1;
  static std::size_t size(const forest::Pairs& pairs) { return pairs.first.size(); }
  static std::pair<std::size_t, std::size_t> ends(const forest::Pairs& pairs, std::size_t k) {
    return {pairs.first[k], pairs.second[k]};
  }
  static std::size_t ends_count(const forest::Pairs& pairs) { return pairs.trees; }
};
template <>
struct plumb::TypeTraits<forest::Gap> {
  static constexpr const char* name = "forest.Gap";
  static constexpr int version = 1;
  static const ItemKind& kind() { return forest::pair_kind(); }
};
template <>
struct plumb::TypeTraits<forest::Tally> {
  static constexpr const char* name = "forest.Tally";
  static constexpr int version = 1;
  static const std::vector<Number>& numbers(const forest::Tally& tally) { return tally.numbers; }
};
template <>
struct plumb::InputTraits<forest::OverPairs> : plumb::PartOf<forest::Pairs> {
  static constexpr const char* sees = "says which pairs there are";
  static SeenPart part(const forest::Pairs&, const ItemPlace&) { return {}; }
  static void set(forest::OverPairs&, const PortInput&) {}
};
