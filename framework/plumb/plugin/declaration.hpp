#pragma once
/// A step declares itself once. From these lines come the checks, `plumb inspect`, the schema, the
/// manifest and the page.
///
///   static void describe(Declaration<VoxelGrid>& is) {
///     is.name("filter.voxel_grid").version(1).summary("Keeps one point per cubic
///     cell.").source("[Tang2024] 2.2"); is.input("segment", &In::segment, "the cloud to thin");
///     is.output("segment", &Out::segment, "its cells' means");
///     is.param("voxel_size", &Params::voxel_size).unit("m").range(0.01, 100).doc("edge length of a
///     voxel");
///   }

#include <limits>
#include <optional>
#include <stdexcept>
#include <utility>

#include "plumb/plugin/step.hpp"

namespace plumb {

/// Fluent description of one parameter; returned by Declaration::param.
class ParameterBuilder {
 public:
  explicit ParameterBuilder(ParameterDescription& description) : of_(&description) {}
  /// Unit of the C++ field: "m", "rad", "s", "m/s", "rad/s", "rad/m", "Hz", or "%" for a ratio (the
  /// field holds 0.02 for 2 %).
  ParameterBuilder& unit(const char* symbol) {
    const Unit* unit = find_unit(symbol);
    if (!unit) throw std::logic_error("parameter '" + of_->name + "': no such unit");
    of_->quantity = unit->quantity;
    return *this;
  }
  /// Inclusive bounds, SI.
  ParameterBuilder& range(double low, double high = std::numeric_limits<double>::infinity()) {
    of_->low = low;
    of_->high = high;
    return *this;
  }
  ParameterBuilder& doc(const char* text) {
    of_->doc = text;
    return *this;
  }
  ParameterBuilder& source(const char* text) {
    of_->source = text;
    return *this;
  }
  ParameterBuilder& required() {
    of_->required = true;
    return *this;
  }
  /// Does not change the result, only how it is reached: not part of an item's key.
  ParameterBuilder& without_effect() {
    of_->affects_result = false;
    return *this;
  }

 private:
  ParameterDescription* of_;
};

template <class E>
struct ChoiceOf {
  const char* name;
  E value;
  const char* doc;
};

/// How a member of an In looks at its wire: the type and the access of the port, and how the member
/// is filled. The specialisations are the list of what an In may hold; a module may add its own
/// (PartOf).
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

/// Base of the InputTraits of a member that sees, of one value T of the pipeline, what concerns its
/// item alone. Beside `set` they have
///   static constexpr const char* sees;                         for people
///   static SeenPart part(const T&, const ItemPlace&);          empty: nothing
/// and may have
///   static std::size_t ends_count(const T&);                   Step::ends_count
template <class T>
struct PartOf {
  using Whole = T;
  static constexpr Access access = Access::part;
  static const Type& type() { return type_of<T>(); }
};

namespace detail {

/// What the engine asks of an input that sees a part.
struct PartCode {
  SeenPart (*part)(const void* value, const ItemPlace& item) = nullptr;
  std::optional<std::size_t> (*ends_count)(const void* value) = nullptr;
};
template <class Traits>
PartCode part_code() {
  if constexpr (Traits::access == Access::part) {
    using T = typename Traits::Whole;
    return {[](const void* value, const ItemPlace& item) {
              return Traits::part(*static_cast<const T*>(value), item);
            },
            [](const void* value) -> std::optional<std::size_t> {
              if constexpr (requires(const T& whole) { Traits::ends_count(whole); })
                return Traits::ends_count(*static_cast<const T*>(value));
              (void)value;
              return std::nullopt;
            }};
  } else {
    return {};
  }
}

template <class T>
struct is_optional : std::false_type {};
template <class T>
struct is_optional<std::optional<T>> : std::true_type {};

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

template <class S>
class Declaration {
 public:
  using In = typename S::In;
  using Out = typename S::Out;
  using Params = typename S::Params;

  explicit Declaration(StepDescription& description) : of_(description) {
    of_.items = S::items();
    of_.parameters.reserve(64);  // builders point into it
  }

  Declaration& name(const char* text) { return of_.name = text, *this; }
  Declaration& version(int number) { return of_.version = number, *this; }
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

  /// A parameter of type double, int, std::uint32_t, std::int64_t, bool, std::string,
  /// std::filesystem::path, or std::optional of one of these (then 'none' may be written). The
  /// default is what the member has in a fresh Params.
  template <class M>
  ParameterBuilder param(const char* parameter, M Params::*member) {
    if constexpr (detail::is_optional<M>::value) {
      auto& p = add_param<typename M::value_type>(parameter);
      p.may_be_none = true;
      const M& standard = standard_.*member;
      if (standard) p.standard = to_value(*standard);
      setters_.push_back({parameter, [member](Params& params, const ParameterValue& v) {
                            if (std::holds_alternative<std::monostate>(v))
                              params.*member = std::nullopt;
                            else
                              params.*member = from_value<typename M::value_type>(v);
                          }});
      if constexpr (std::is_same_v<typename M::value_type, double>)
        scalers_.push_back({of_.parameters.size() - 1, [member](Params& params, double factor) {
                              if (params.*member) *(params.*member) *= factor;
                            }});
      return ParameterBuilder(p);
    } else {
      auto& p = add_param<M>(parameter);
      p.standard = to_value(standard_.*member);
      setters_.push_back({parameter, [member](Params& params, const ParameterValue& v) {
                            params.*member = from_value<M>(v);
                          }});
      if constexpr (std::is_same_v<M, double>)
        scalers_.push_back({of_.parameters.size() - 1,
                            [member](Params& params, double factor) { params.*member *= factor; }});
      return ParameterBuilder(p);
    }
  }
  /// A parameter that is one of an enum's values, each with its name in YAML and what it means.
  template <class E>
  ParameterBuilder choice(const char* parameter, E Params::*member,
                          std::vector<ChoiceOf<E>> choices) {
    auto& p = add_param<std::string>(parameter);
    p.kind = ParameterKind::choice;
    for (const auto& c : choices) {
      p.choices.push_back({c.name, c.doc});
      if (c.value == standard_.*member) p.standard = std::string(c.name);
    }
    setters_.push_back({parameter, [member, choices](Params& params, const ParameterValue& v) {
                          for (const auto& c : choices)
                            if (std::get<std::string>(v) == c.name) params.*member = c.value;
                        }});
    return ParameterBuilder(p);
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
  Params scaled(Params params, double factor) const {
    for (const auto& [place, scale] : scalers_)
      if (of_.parameters[place].quantity == Quantity::length)
        scale(params, factor);
      else if (of_.parameters[place].quantity == Quantity::curvature)
        scale(params, 1 / factor);
    return params;
  }
  Params make_params(const ParameterValues& values) const {
    Params params;
    for (const auto& [parameter, set] : setters_)
      if (const auto at = values.find(parameter); at != values.end()) set(params, at->second);
    if constexpr (requires { params.check(); })
      if (const std::string fault = params.check(); !fault.empty()) throw Error(fault);
    return params;
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
  template <class T>
  ParameterDescription& add_param(const char* parameter) {
    if (of_.parameters.size() == of_.parameters.capacity())
      throw std::logic_error("too many parameters");
    auto& p = of_.parameters.emplace_back();
    p.name = parameter;
    p.low = -std::numeric_limits<double>::infinity();
    p.high = std::numeric_limits<double>::infinity();
    if constexpr (std::is_same_v<T, bool>)
      p.kind = ParameterKind::boolean;
    else if constexpr (std::is_integral_v<T>)
      p.kind = ParameterKind::integer;
    else if constexpr (std::is_floating_point_v<T>)
      p.kind = ParameterKind::number;
    else if constexpr (std::is_same_v<T, std::filesystem::path>)
      p.kind = ParameterKind::path;
    else
      p.kind = ParameterKind::text;
    if constexpr (std::is_unsigned_v<T> && !std::is_same_v<T, bool>) p.low = 0;
    if constexpr (std::is_integral_v<T> && !std::is_same_v<T, bool> && sizeof(T) <= 4)
      p.high = static_cast<double>(std::numeric_limits<T>::max());
    return p;
  }
  template <class T>
  static ParameterValue to_value(const T& v) {
    if constexpr (std::is_same_v<T, bool>)
      return v;
    else if constexpr (std::is_integral_v<T>)
      return static_cast<std::int64_t>(v);
    else if constexpr (std::is_floating_point_v<T>)
      return static_cast<double>(v);
    else if constexpr (std::is_same_v<T, std::filesystem::path>)
      return v.string();
    else
      return std::string(v);
  }
  template <class T>
  static T from_value(const ParameterValue& v) {
    if constexpr (std::is_same_v<T, bool>)
      return std::get<bool>(v);
    else if constexpr (std::is_integral_v<T>)
      return static_cast<T>(std::get<std::int64_t>(v));
    else if constexpr (std::is_floating_point_v<T>)
      return static_cast<T>(std::get<double>(v));
    else
      return T(std::get<std::string>(v));
  }

  StepDescription& of_;
  Params standard_;
  std::vector<std::function<void(In&, const PortInput&)>> takers_;
  std::vector<detail::PartCode> parts_;  ///< by input
  std::vector<std::function<void(Out&, PortOutput&)>> getters_;
  std::vector<std::pair<std::string, std::function<void(Params&, const ParameterValue&)>>> setters_;
  std::vector<std::pair<std::size_t, std::function<void(Params&, double)>>>
      scalers_;  ///< of the parameter with that place
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
