#pragma once
/// The members of a step's `In` and `Out`: their types say how the step looks at a wire.
///
///   One<T>       the value of the same item (frame, segment, edge), or the one value of the
///   pipeline Ends<T>      the values of an edge's two segments, .i and .j (EdgeStep) Each<T> all
///   values in order, opened one at a time                             (WholeStep; SegmentStep: own
///   frames) Several<T>   any number of pipeline values, each with a label (WholeStep) Relative of
///   Poses only T_i_j of the edge                                       (EdgeStep) OverEdges which
///   edges there are; the content is not seen and not in the key     (EdgeStep) ThisEdge     the
///   edge itself                                                       (EdgeStep)
///
/// In `Out`: T (one value), std::vector<T> (one per segment, from a WholeStep or FoldStep), Lazy<T>
/// (made when asked for). Many values open items of their own, unless the declaration says whose
/// they are: `.output(...).over("segments")`.

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
  virtual const Edges* edges() const { return nullptr; }  ///< of edge-wise values
};

template <class T>
class Each {
 public:
  Each() = default;
  explicit Each(std::shared_ptr<const Collection> items) : items_(std::move(items)) {}
  explicit operator bool() const { return items_ != nullptr; }
  std::size_t size() const { return items_->size(); }
  One<T> open(std::size_t k) const { return One<T>(items_->open(k).template as<T>()); }
  /// The edges that edge-wise values belong to: value k is that of edges().list[k].
  const Edges& edges() const { return *items_->edges(); }

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

struct Relative {
  Pose T_i_j;
  bool wired = false;
  explicit operator bool() const { return wired; }
};
struct OverEdges {
  bool wired = false;
};
struct ThisEdge {
  Edge edge;
  bool wired = false;
  explicit operator bool() const { return wired; }
};

/// Values that are made when they are asked for, such as frames read from files.
template <class T>
struct Lazy {
  std::vector<Hash128>
      keys;  ///< one a value: changes when the value would (path, size and time of a file)
  std::function<T(std::size_t k, Context& context)> open;  ///< pure, safe from several threads
};

}  // namespace plumb
