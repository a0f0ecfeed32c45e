#include "plumb/plugin/parameter_set.hpp"

#include <gmock/gmock.h>

#include "plumb/plugin/testing.hpp"
#include "plumb/plugin/toy_testing.hpp"

namespace plumb {
namespace {

using testing::ElementsAre;
using toy::Metrics;

enum class Norm { square, robust };

/// Options of a kernel, declared beside their definition.
struct SearchOptions {
  double radius = 2;                ///< [m]
  std::optional<double> bend = {};  ///< [rad/m]
  std::uint32_t max_rounds = 5;
  Norm norm = Norm::square;

  template <class Declare>
  static void describe(Declare& is) {
    is.param("radius", &SearchOptions::radius)
        .unit("m")
        .range(0.1, 10)
        .doc("how far to look")
        .source("ours");
    is.param("bend", &SearchOptions::bend).unit("rad/m").doc("of the path; none: any");
    is.param("max_rounds", &SearchOptions::max_rounds).range(1, 100);
    is.choice("norm", &SearchOptions::norm,
              {{"square", Norm::square, "least squares"},
               {"robust", Norm::robust, "outliers count less"}});
  }
};

Metrics seen(const SearchOptions& options) {
  Metrics metrics;
  metrics.add("radius", options.radius, "m").add("bend", options.bend.value_or(-1), "rad/m");
  metrics.add("max_rounds", options.max_rounds, "");
  metrics.add("robust", options.norm == Norm::robust ? 1 : 0, "");
  return metrics;
}

/// Its output says what the options are in a call.
struct Probe : WholeStep {
  struct In {
    One<Metrics> scale;
  };
  struct Out {
    Metrics seen;
  };
};

/// Takes the options as they are, between parameters of its own.
struct TakesAll : Probe {
  struct Params {
    double before = 1;
    SearchOptions search;
    int after = 2;
  };
  static void describe(Declaration<TakesAll>& is) {
    is.name("test.takes_all").version(1).scale(&In::scale);
    is.output("seen", &Out::seen, "the options");
    is.param("before", &Params::before);
    is.params(&Params::search);
    is.param("after", &Params::after);
  }
  Out run(const In&, const Params& params, Context&) const { return {seen(params.search)}; }
};

struct HoldsOthers {
  SearchOptions search = {.radius = 4, .norm = Norm::robust};
};

/// Takes some, with defaults of its own, and says of them what is otherwise.
struct TakesSome : Probe {
  struct Params : HoldsOthers {
    double own = 1;
  };
  static void describe(Declaration<TakesSome>& is) {
    is.name("test.takes_some").version(1).scale(&In::scale);
    is.output("seen", &Out::seen, "the options");
    is.params(&Params::search, {"norm", "radius"});
    is.param("norm").choices({{"robust", "the usual"}, {"square", "for tests"}});
    is.param("radius").range(0.5, 3).doc("how far to track").named("search_radius");
    is.param("own", &Params::own);
  }
  Out run(const In&, const Params& params, Context&) const { return {seen(params.search)}; }
};

std::vector<std::string> names(const StepDescription& step) {
  std::vector<std::string> all;
  for (const auto& parameter : step.parameters) all.push_back(parameter.name);
  return all;
}

/// What a call of S sees as radius, bend, rounds and norm: `given` and else the defaults.
template <class S>
std::vector<double> seen_by(const ParameterValues& given, double scale = 1) {
  const StepOf<S> step;
  ParameterValues values = given;
  for (const auto& p : step.description().parameters) values.emplace(p.name, p.standard);
  std::vector<PortInput> inputs(1);
  inputs[0].wired = true;
  inputs[0].one = any_value(Metrics().add("scale", scale, ""));
  std::vector<PortOutput> outputs(1);
  TestContext context;
  step.run(step.parameters(values).get(), inputs, outputs, context);
  std::vector<double> numbers;
  for (const auto& number : outputs[0].one.as<Metrics>()->numbers) numbers.push_back(number.value);
  return numbers;
}

TEST(ParameterSet, TakesAllThatAMemberDeclares) {
  const StepOf<TakesAll> step;
  EXPECT_THAT(names(step.description()),
              ElementsAre("before", "radius", "bend", "max_rounds", "norm", "after"));
  const ParameterDescription& radius = *step.description().parameter("radius");
  EXPECT_EQ(range_text(radius), "length, 0.1 m to 10 m");
  EXPECT_EQ(written(radius, radius.standard), "2 m");
  EXPECT_EQ(radius.doc, "how far to look");
  EXPECT_EQ(radius.source, "ours");
  const ParameterDescription& bend = *step.description().parameter("bend");
  EXPECT_EQ(bend.quantity, Quantity::curvature);
  EXPECT_EQ(written(bend, bend.standard), "none");
  EXPECT_EQ(step.description().parameter("norm")->choices.at(1).doc, "outliers count less");
}

TEST(ParameterSet, BringsValuesToTheMember) {
  EXPECT_THAT(seen_by<TakesAll>({}), ElementsAre(2, -1, 5, 0));
  EXPECT_THAT(seen_by<TakesAll>({{"radius", 0.5},
                                 {"bend", 0.25},
                                 {"max_rounds", std::int64_t{7}},
                                 {"norm", std::string("robust")}}),
              ElementsAre(0.5, 0.25, 7, 1));
}

TEST(ParameterSet, ScalesLengthsOfTheMember) {
  EXPECT_THAT(seen_by<TakesAll>({{"bend", 0.5}}, 2), ElementsAre(4, 0.25, 5, 0));
  EXPECT_THAT(seen_by<TakesAll>({}, 2), ElementsAre(4, -1, 5, 0));
  EXPECT_THAT(seen_by<TakesSome>({}, 2), ElementsAre(8, -1, 5, 1));
}

TEST(ParameterSet, TakesSomeInTheirOrderWithTheDefaultsOfWhatHoldsThem) {
  const StepOf<TakesSome> step;
  EXPECT_THAT(names(step.description()), ElementsAre("norm", "search_radius", "own"));
  const ParameterDescription& norm = *step.description().parameter("norm");
  EXPECT_EQ(written(norm, norm.standard), "robust");
  EXPECT_THAT(seen_by<TakesSome>({}), ElementsAre(4, -1, 5, 1));
}

TEST(ParameterSet, SaysOfOneWhatIsOtherwise) {
  const StepOf<TakesSome> step;
  const ParameterDescription& radius = *step.description().parameter("search_radius");
  EXPECT_EQ(range_text(radius), "length, 0.5 m to 3 m");
  EXPECT_EQ(radius.doc, "how far to track");
  EXPECT_EQ(radius.source, "ours");
  EXPECT_EQ(range_text(*step.description().parameter("norm")), "one of robust, square");
  EXPECT_THAT(seen_by<TakesSome>({{"search_radius", 1.0}, {"norm", std::string("square")}}),
              ElementsAre(1, -1, 5, 0));
}

struct Inner {
  double length = 1;
  template <class Declare>
  static void describe(Declare& is) {
    is.param("length", &Inner::length).unit("m");
  }
};
struct Outer {
  Inner inner = {3};
  template <class Declare>
  static void describe(Declare& is) {
    is.params(&Outer::inner);
  }
};
struct Outermost {
  Outer outer;
};

TEST(ParameterSet, ReachesIntoStructsInStructs) {
  std::vector<ParameterDescription> described;
  ParameterSet<Outermost> is(described, Outermost());
  is.params(&Outermost::outer);
  EXPECT_EQ(std::get<double>(described.at(0).standard), 3);
  const Outermost made = is.make_params({{"length", 5.0}});
  EXPECT_EQ(made.outer.inner.length, 5);
  EXPECT_EQ(is.scaled(made, 2).outer.inner.length, 10);
}

TEST(ParameterSet, RefusesWhatTheOptionsDoNotHaveAndWhatIsThereAlready) {
  std::vector<ParameterDescription> described;
  ParameterSet<TakesAll::Params> is(described, TakesAll::Params());
  EXPECT_THROW(is.params(&TakesAll::Params::search, {"diameter"}), std::logic_error);
  is.params(&TakesAll::Params::search);
  EXPECT_THROW(is.params(&TakesAll::Params::search, {"radius"}), std::logic_error);
  EXPECT_THROW(is.param("diameter"), std::logic_error);
  EXPECT_THROW(is.param("norm").choices({{"square", ""}, {"cube", ""}}), std::logic_error);
}

}  // namespace
}  // namespace plumb
