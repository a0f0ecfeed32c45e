#pragma once
/// The five step bases, and the one face that the engine sees of any step.

#include <span>

#include "plumb/plugin/description.hpp"
#include "plumb/plugin/port.hpp"

namespace plumb {

/// A step derives from the base that says what one call sees, and has
///   struct In  {...};   members of port.hpp's kinds
///   struct Out {...};
///   struct Params {...};                      plain, with defaults; optionally std::string check()
///   const: "" or what is wrong static void describe(Declaration<Self>&); name, version, ports,
///   parameters: see declaration.hpp Out run(const In&, const Params&, Context&) const;
struct FrameStep {
  static constexpr StepKind kind = StepKind::frame;
};
struct SegmentStep {
  static constexpr StepKind kind = StepKind::segment;
};
struct EdgeStep {
  static constexpr StepKind kind = StepKind::edge;
};
struct WholeStep {
  static constexpr StepKind kind = StepKind::whole;
};
/// A FoldStep sees frames in order. Instead of run it has
///   struct State {...};  with fields(archive, state), so that it can be saved and taken up
///   void fold(State&, const In&, const Params&, Context&) const;   In holds one One<Frame>; other
///   members are pipeline values Out finish(State&&, const Params&, Context&) const;
struct FoldStep {
  static constexpr StepKind kind = StepKind::fold;
};

/// One input of one call, of unknown type.
struct PortInput {
  bool wired = false;
  AnyValue one, other;  ///< item; ends: i in one, j in other
  std::shared_ptr<const Collection> each;
  std::vector<std::pair<std::string, AnyValue>> several;
  Pose T_i_j;
  Edge edge;
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

  /// A fold's state: made fresh, or from the bytes of a saved one; saved; moved on by one frame;
  /// finished.
  virtual std::shared_ptr<void> begin(std::string_view saved) const = 0;
  virtual std::string save(const void* state) const = 0;
  virtual void fold(void* state, const void* params, std::span<const PortInput> inputs,
                    Context& context) const = 0;
  virtual void finish(void* state, const void* params, std::span<PortOutput> outputs,
                      Context& context) const = 0;

 protected:
  StepDescription description_;
};

}  // namespace plumb
