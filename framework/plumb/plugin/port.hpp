#pragma once
/// The members of a step's `In` and `Out`: their types say how the step looks at a wire.
///
///   One<T>      the value of the same item, or the one value of the pipeline
///   Ends<T>     the values of the two items that an item joins, .i and .j (edges: two segments)
///   Each<T>     all values in order, opened one at a time; of a step on items that are made of
///               parts (segments: frames) those of its own parts
///   Several<T>  any number of pipeline values, each with a label
///
/// A part may add views of its own: InputTraits (port_traits.hpp), as slam/step.hpp does with
/// Relative.
///
/// In `Out`: T (one value), std::vector<T> (one per item, from a WholeStep), Lazy<T> (made when
/// asked for). Many values open items of their own, unless the declaration says whose they are:
/// `.output(...).over("segments")`.

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "plumb/data/type.hpp"
#include "plumb/plugin/context.hpp"

namespace plumb {

/// A value, shared and immutable. Empty only for an optional input that is not wired.
template <class T>
class One {
 public:
  One() = default;
  One(T value)
      : value_(std::make_shared<const T>(std::move(value))) {}  // NOLINT: tests pass values
  explicit One(std::shared_ptr<const T> value) : value_(std::move(value)) {}
  explicit operator bool() const { return value_ != nullptr; }
  const T& operator*() const { return *value_; }
  const T* operator->() const { return value_.get(); }
  const std::shared_ptr<const T>& shared() const { return value_; }

 private:
  std::shared_ptr<const T> value_;
};

template <class T>
struct Ends {
  One<T> i, j;
  explicit operator bool() const { return static_cast<bool>(i); }
};

/// An ordered collection behind an Each: the engine's, or a test's vector.
class Collection {
 public:
  virtual ~Collection() = default;
  virtual std::size_t size() const = 0;
  virtual AnyValue open(
      std::size_t k) const = 0;  ///< computed or fetched; safe from several threads
  /// The list of the items that the values belong to; empty where their kind has none.
  virtual AnyValue list() const { return {}; }
};

template <class T>
class Each {
 public:
  Each() = default;
  explicit Each(std::shared_ptr<const Collection> items) : items_(std::move(items)) {}
  explicit operator bool() const { return items_ != nullptr; }
  std::size_t size() const { return items_->size(); }
  One<T> open(std::size_t k) const { return One<T>(items_->open(k).template as<T>()); }
  /// All of them, copied: for small values.
  std::vector<T> all(Context& context) const {
    std::vector<T> values(size());
    context.parallel(values.size(), [&](std::size_t k) { values[k] = *open(k); });
    return values;
  }
  /// Of values of a kind whose items are listed: the list. Value k belongs to its item k.
  AnyValue list() const { return items_->list(); }

 private:
  std::shared_ptr<const Collection> items_;
};

template <class T>
struct Labelled {
  std::string label;
  One<T> value;
};
template <class T>
using Several = std::vector<Labelled<T>>;

/// Which item a call is about: its place, and of an item that joins two others theirs.
struct ItemPlace {
  std::size_t k = 0, i = 0, j = 0;
};

/// What a call sees of a value of the pipeline that concerns all items: the part of its own item.
/// Nothing else of the value is in the call's key; an empty part is not in it either.
struct SeenPart {
  std::shared_ptr<const void> value;
  Hash128 hash;
  template <class T>
  const T* as() const {
    return static_cast<const T*>(value.get());
  }
};
template <class T>
SeenPart seen_part(T value) {
  const Hash128 hash = content_hash(value);
  return {std::make_shared<const T>(std::move(value)), hash};
}

/// Values that are made when they are asked for, such as frames read from files.
template <class T>
struct Lazy {
  std::vector<Hash128>
      keys;  ///< one a value: changes when the value would (path, size and time of a file)
  std::function<T(std::size_t k, Context& context)> open;  ///< pure, safe from several threads
};

}  // namespace plumb
