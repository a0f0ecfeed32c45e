#pragma once
/// The step bases, and the one face that the engine sees of any step.

#include <optional>
#include <span>

#include "plumb/plugin/description.hpp"
#include "plumb/plugin/port.hpp"

namespace plumb {

/// A step derives from the base that says what one call sees, and has
///   struct In  {...};     members of port.hpp's kinds
///   struct Out {...};
///   struct Params {...};  plain, with defaults; optionally std::string check() const: "" or what
///                         is wrong
///   static void describe(Declaration<Self>&);   name, version, ports, parameters: declaration.hpp
///   Out run(const In&, const Params&, Context&) const;

/// One call sees whole collections.
struct WholeStep {
  static const ItemKind* items() { return nullptr; }
};
/// One call sees one item of a kind: `using SegmentStep = ItemStep<&segment_kind>;`
template <const ItemKind& (*Kind)()>
struct ItemStep {
  static const ItemKind* items() { return &define_kind(Kind()); }
};

/// One input of one call, of unknown type.
struct PortInput {
  bool wired = false;
  AnyValue one, other;  ///< item; ends: i in one, j in other
  std::shared_ptr<const Collection> each;
  std::vector<std::pair<std::string, AnyValue>> several;
  SeenPart part;
};

/// What a lazy output makes.
struct LazyItems {
  std::vector<Hash128> keys;
  std::function<AnyValue(std::size_t, Context&)> open;
};

/// One output of one call.
struct PortOutput {
  AnyValue one;
  std::vector<AnyValue> many;
  LazyItems lazy;
};

/// A step as the engine sees it. All functions are safe from several threads.
class Step {
 public:
  virtual ~Step() = default;
  const StepDescription& description() const { return description_; }

  /// The step's Params, filled from `values` (complete and checked). Throws Error where values do
  /// not go together.
  virtual std::shared_ptr<const void> parameters(const ParameterValues& values) const = 0;
  /// One call: inputs and outputs in the order of the description.
  virtual void run(const void* params, std::span<const PortInput> inputs,
                   std::span<PortOutput> outputs, Context& context) const = 0;

  /// Of an input that sees a part of a value: that of an item.
  virtual SeenPart part(std::size_t input, const void* value, const ItemPlace& item) const = 0;
  /// How many of the items that an item joins the value is about; none when it does not say.
  virtual std::optional<std::size_t> ends_count(std::size_t input, const void* value) const = 0;

 protected:
  StepDescription description_;
};

}  // namespace plumb
