#pragma once
/// What the items of a collection are: frames, segments, edges, or what another module defines.

#include <string>

namespace plumb {

/// How many values a type has in a run: one for each item of a kind. Types without a kind have one
/// value for the whole pipeline. Everything here is known from a manifest, before the module that
/// defines the kind is loaded; types are meant by their registered names.
///
/// An item may be made of consecutive items of another kind (a segment of frames), which a value of
/// the type `ranges`, one an item, says. Or it joins two items of another kind (an edge two
/// segments); then one value of the type `list` says which items there are.
struct ItemKind {
  std::string name = {};    ///< "segment"
  std::string parts = {};   ///< the kind of what an item is made of; empty: of nothing
  std::string ranges = {};  ///< the type that says of which parts
  std::string ends = {};    ///< the kind of the two items that an item joins; empty: it joins none
  std::string list = {};    ///< the type that lists the items
  bool transient = false;   ///< values are made anew whenever they are asked for, and never kept

  bool operator==(const ItemKind&) const = default;
};

/// Registers a kind, which lives until the process ends; the kind of that name if it is the same.
/// Throws Error when another of that name is there.
const ItemKind& define_kind(const ItemKind& kind);

/// The kind with this name, or null.
const ItemKind* find_kind(std::string_view name);

}  // namespace plumb
