#pragma once
/// The parameters of a struct: what is said of each, and how its value gets into the struct. A
/// step's Params is such a struct. Options of a kernel that Params holds declare themselves, beside
/// their definition and once for all steps that take them; so the kernel need not know the SDK:
///
///   struct IcpOptions {
///     double max_correspondence_distance = 0.3;  ///< [m]
///
///     template <class Declare>
///     static void describe(Declare& is) {
///       is.param("max_correspondence_distance", &IcpOptions::max_correspondence_distance)
///           .unit("m")
///           .range(1e-3, 100)
///           .doc("distance between the two points of a pair");
///     }
///   };
///
/// and a step whose Params has a member `IcpOptions icp` takes them by is.params(&Params::icp).

#include <functional>
#include <initializer_list>
#include <optional>
#include <string_view>

#include "plumb/data/error.hpp"
#include "plumb/plugin/parameter_builder.hpp"
#include "plumb/plugin/parameter_value.hpp"

namespace plumb {

template <class E>
struct ChoiceOf {
  const char* name;
  E value;
  const char* doc;
};

template <class Options>
class ParameterSet {
 public:
  /// Describes parameters in `described`, which is empty and lives longer; their defaults are what
  /// `standard` holds.
  ParameterSet(std::vector<ParameterDescription>& described, Options standard)
      : described_(described), standard_(std::move(standard)) {
    described_.reserve(64);  // builders point into it
  }

  /// A parameter of type double, int, std::uint32_t, std::int64_t, bool, std::string,
  /// std::filesystem::path, or std::optional of one of these (then 'none' may be written); the
  /// member may be inherited. The default is what it has in a fresh Options.
  template <class M, class Base>
  ParameterBuilder param(const char* parameter, M Base::*member) {
    M Options::*const own = member;
    const M& standard = standard_.*own;
    Accessor access;
    if constexpr (detail::is_optional<M>::value) {
      using T = typename M::value_type;
      auto description = detail::description_of<T>(parameter);
      description.may_be_none = true;
      if (standard) description.standard = detail::to_value(*standard);
      access.set = [own](Options& options, const ParameterValue& v) {
        if (std::holds_alternative<std::monostate>(v))
          options.*own = std::nullopt;
        else
          options.*own = detail::from_value<T>(v);
      };
      if constexpr (std::is_same_v<T, double>)
        access.scale = [own](Options& options, double factor) {
          if (options.*own) *(options.*own) *= factor;
        };
      return add(std::move(description), std::move(access));
    } else {
      auto description = detail::description_of<M>(parameter);
      description.standard = detail::to_value(standard);
      access.set = [own](Options& options, const ParameterValue& v) {
        options.*own = detail::from_value<M>(v);
      };
      if constexpr (std::is_same_v<M, double>)
        access.scale = [own](Options& options, double factor) { options.*own *= factor; };
      return add(std::move(description), std::move(access));
    }
  }

  /// A parameter that is one of an enum's values, each with its name in YAML and what it means.
  template <class E, class Base>
  ParameterBuilder choice(const char* parameter, E Base::*member,
                          std::vector<ChoiceOf<E>> choices) {
    E Options::*const own = member;
    auto description = detail::description_of<std::string>(parameter);
    description.kind = ParameterKind::choice;
    for (const auto& c : choices) {
      description.choices.push_back({c.name, c.doc});
      if (c.value == standard_.*own) description.standard = std::string(c.name);
    }
    Accessor access;
    access.set = [own, choices](Options& options, const ParameterValue& v) {
      for (const auto& c : choices)
        if (std::get<std::string>(v) == c.name) options.*own = c.value;
    };
    return add(std::move(description), std::move(access));
  }

  /// The parameters of a member that declares itself: all of them as it has them, or only those
  /// named, in that order. Their defaults are what the member has in a fresh Options.
  template <class Held, class Base>
  void params(Held Base::*member, std::initializer_list<std::string_view> only = {}) {
    Held Options::*const own = member;
    std::vector<ParameterDescription> described;
    ParameterSet<Held> held(described, standard_.*own);
    Held::describe(held);
    if (only.size() == 0)
      for (std::size_t k = 0; k < described.size(); ++k) take(own, held, k);
    for (const std::string_view parameter : only) take(own, held, held.place_of(parameter));
  }

  /// A parameter that was taken, to say of it what is otherwise in this step.
  ParameterBuilder param(const char* parameter) {
    return ParameterBuilder(described_[place_of(parameter)]);
  }

  /// Throws Error where the values do not go together.
  Options make_params(const ParameterValues& values) const {
    Options options;
    for (std::size_t k = 0; k < access_.size(); ++k)
      if (const auto at = values.find(described_[k].name); at != values.end())
        access_[k].set(options, at->second);
    if constexpr (requires { options.check(); })
      if (const std::string fault = options.check(); !fault.empty()) throw Error(fault);
    return options;
  }

  /// With lengths multiplied by the factor, and curvatures divided by it.
  Options scaled(Options options, double factor) const {
    for (std::size_t k = 0; k < access_.size(); ++k) {
      if (!access_[k].scale) continue;
      if (described_[k].quantity == Quantity::length)
        access_[k].scale(options, factor);
      else if (described_[k].quantity == Quantity::curvature)
        access_[k].scale(options, 1 / factor);
    }
    return options;
  }

 private:
  template <class>
  friend class ParameterSet;

  /// How a parameter is reached in an Options.
  struct Accessor {
    std::function<void(Options&, const ParameterValue&)> set;
    std::function<void(Options&, double)> scale;  ///< of a double; else empty
  };

  ParameterBuilder add(ParameterDescription description, Accessor access) {
    if (described_.size() == described_.capacity()) throw std::logic_error("too many parameters");
    for (const auto& p : described_)
      if (p.name == description.name)
        throw std::logic_error("parameter '" + p.name + "' is declared twice");
    access_.push_back(std::move(access));
    return ParameterBuilder(described_.emplace_back(std::move(description)));
  }

  template <class Held>
  void take(Held Options::*own, const ParameterSet<Held>& held, std::size_t k) {
    Accessor access;
    access.set = [own, set = held.access_[k].set](Options& options, const ParameterValue& v) {
      set(options.*own, v);
    };
    if (held.access_[k].scale)
      access.scale = [own, scale = held.access_[k].scale](Options& options, double factor) {
        scale(options.*own, factor);
      };
    add(held.described_[k], std::move(access));
  }

  std::size_t place_of(std::string_view parameter) const {
    for (std::size_t k = 0; k < described_.size(); ++k)
      if (described_[k].name == parameter) return k;
    throw std::logic_error("no parameter '" + std::string(parameter) + "'");
  }

  std::vector<ParameterDescription>& described_;
  std::vector<Accessor> access_;  ///< of described_, in its order
  Options standard_;
};

}  // namespace plumb
