#pragma once
/// A step declares itself once. From these lines come the checks, `plumb inspect`, the schema, the
/// manifest and the page.
///
///   static void describe(Declaration<VoxelGrid>& is) {
///     is.name("filter.voxel_grid").version(1).source("[Tang2024] 2.2");
///     is.summary("Keeps one point per cubic cell.");
///     is.input("segment", &In::segment, "the cloud to thin");
///     is.output("segment", &Out::segment, "its cells' means");
///     is.param("voxel_size", &Params::voxel_size)
///         .unit("m")
///         .range(0.01, 100)
///         .doc("edge length of a voxel");
///   }

#include <limits>
#include <optional>
#include <stdexcept>
#include <utility>

#include "plumb/plugin/parameter_set.hpp"
#include "plumb/plugin/port_traits.hpp"
#include "plumb/plugin/step.hpp"

namespace plumb {

/// What a step says of itself: its name, its ports, and, by ParameterSet, its parameters.
template <class S>
class Declaration : public ParameterSet<typename S::Params> {
 public:
  using In = typename S::In;
  using Out = typename S::Out;
  using Params = typename S::Params;

  explicit Declaration(StepDescription& description)
      : ParameterSet<Params>(description.parameters, Params()), of_(description) {
    of_.items = S::items();
  }

  Declaration& name(const char* text) { return of_.name = text, *this; }
  Declaration& version(int number) { return of_.version = number, *this; }
  /// The author's word that every build with this version gives the same results, so that those of
  /// other builds are taken from the cache. Without it they are made again.
  Declaration& across_builds() { return of_.across_builds = true, *this; }
  Declaration& summary(const char* text) { return of_.summary = text, *this; }
  Declaration& source(const char* text) { return of_.source = text, *this; }

  template <class M>
  Declaration& input(const char* port, M In::*member, const char* doc) {
    return add_input(port, member, doc, false);
  }
  template <class M>
  Declaration& optional_input(const char* port, M In::*member, const char* doc) {
    return add_input(port, member, doc, true);
  }
  template <class M>
  Declaration& output(const char* port, M Out::*member, const char* doc) {
    using Traits = detail::OutputTraits<M>;
    of_.outputs.push_back({port, &Traits::type(), Traits::emission, doc, ""});
    getters_.push_back([member](Out& out, PortOutput& to) { Traits::get(out.*member, to); });
    return *this;
  }
  /// The many values of the output declared last belong to the items of an input declared before,
  /// an Each of the same kind: one value each, in their order. Without this they are items of
  /// their own.
  Declaration& over(const char* input) {
    if (of_.outputs.empty() || of_.outputs.back().emission == Emission::one)
      throw std::logic_error("over(): the last thing declared is no output of many values");
    const InputDescription* of = of_.input(input);
    if (!of || of->access != Access::each || of->type->kind != of_.outputs.back().type->kind)
      throw std::logic_error("output '" + of_.outputs.back().name + "': no input '" + input +
                             "' of items of its kind");
    of_.outputs.back().over = input;
    return *this;
  }

  /// An optional input of a value with numbers (Metrics) whose first one multiplies all of the
  /// step's lengths (parameters in metres; those in 1/m are divided): how large the surroundings
  /// are beside those that the numbers were chosen for. So one pipeline serves a car in a street
  /// and a scanner carried through rooms.
  template <class M>
  Declaration& scale(One<M> In::*member) {
    scale_ = [member](const In& in) -> const std::vector<Number>* {
      return in.*member ? &TypeTraits<M>::numbers(*(in.*member)) : nullptr;
    };
    return add_input("scale", member,
                     "how large the surroundings are beside those that the parameters are for; "
                     "lengths are multiplied by it",
                     true);
  }

  const detail::PartCode& part_code(std::size_t input) const { return parts_[input]; }
  In make_in(std::span<const PortInput> inputs) const {
    In in;
    for (std::size_t k = 0; k < takers_.size(); ++k)
      if (inputs[k].wired) takers_[k](in, inputs[k]);
    return in;
  }
  void give_out(Out& out, std::span<PortOutput> outputs) const {
    for (std::size_t k = 0; k < getters_.size(); ++k) getters_[k](out, outputs[k]);
  }
  /// The factor of lengths that came in, or 1. Throws Error where it is no factor.
  double scale_of(const In& in) const {
    const std::vector<Number>* given = scale_ ? scale_(in) : nullptr;
    if (!given) return 1;
    const std::vector<Number>& numbers = *given;
    if (numbers.empty() || !(numbers.front().value > 0 &&
                             numbers.front().value < std::numeric_limits<double>::infinity()))
      throw Error(
          "'scale' must have a positive number: wire a value whose first number is the factor");
    return numbers.front().value;
  }

 private:
  template <class M>
  Declaration& add_input(const char* port, M In::*member, const char* doc, bool optional) {
    using Traits = InputTraits<M>;
    of_.inputs.push_back({port, &Traits::type(), Traits::access, optional, doc, ""});
    if constexpr (Traits::access == Access::part) of_.inputs.back().sees = Traits::sees;
    parts_.push_back(detail::part_code<Traits>());
    takers_.push_back([member](In& in, const PortInput& from) { Traits::set(in.*member, from); });
    return *this;
  }

  StepDescription& of_;
  std::vector<std::function<void(In&, const PortInput&)>> takers_;
  std::vector<detail::PartCode> parts_;  ///< by input
  std::vector<std::function<void(Out&, PortOutput&)>> getters_;
  std::function<const std::vector<Number>*(const In&)> scale_;  ///< null where it is not wired
};

/// The engine's face of a step S.
template <class S>
class StepOf final : public Step {
 public:
  StepOf() : declaration_(description_) { S::describe(declaration_); }

  std::shared_ptr<const void> parameters(const ParameterValues& values) const override {
    return std::make_shared<const typename S::Params>(declaration_.make_params(values));
  }
  void run(const void* params, std::span<const PortInput> inputs, std::span<PortOutput> outputs,
           Context& context) const override {
    const auto in = declaration_.make_in(inputs);
    const double factor = declaration_.scale_of(in);
    auto out = factor == 1 ? S{}.run(in, params_of(params), context)
                           : S{}.run(in, declaration_.scaled(params_of(params), factor), context);
    declaration_.give_out(out, outputs);
  }
  SeenPart part(std::size_t input, const void* value, const ItemPlace& item) const override {
    return declaration_.part_code(input).part(value, item);
  }
  std::optional<std::size_t> ends_count(std::size_t input, const void* value) const override {
    const auto code = declaration_.part_code(input).ends_count;
    return code ? code(value) : std::nullopt;
  }

 private:
  static const typename S::Params& params_of(const void* params) {
    return *static_cast<const typename S::Params*>(params);
  }
  Declaration<S> declaration_;
};

}  // namespace plumb
