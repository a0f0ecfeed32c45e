/// Results leave memory when the last step that may ask for them is done.
#include <gtest/gtest.h>

#include <atomic>

#include "plumb/data/io/file_testing.hpp"
#include "plumb/engine/run/runner.hpp"
#include "plumb/engine/testing/test_steps.hpp"
#include "plumb/pipeline/reader.hpp"

namespace plumb {
namespace release_test {

/// A value that knows how many of its kind there are.
struct Held {
  static inline std::atomic<int> alive{0};
  double x = 0;
  Held() { ++alive; }
  Held(const Held& other) : x(other.x) { ++alive; }
  Held& operator=(const Held& other) = default;
  ~Held() { --alive; }
};
template <class Archive, class T>
requires std::is_same_v<std::remove_const_t<T>, Held>
void fields(Archive& a, T& held) { a(held.x); }

}  // namespace release_test

template <>
struct TypeTraits<release_test::Held> {
  static constexpr const char* name = "Held";
  static constexpr int version = 1;
};

namespace {

using release_test::Held;

struct Give : WholeStep {
  struct In {};
  struct Params {};
  struct Out {
    Held held;
  };
  static void describe(Declaration<Give>& is) {
    is.name("test.give").version(1).summary("Gives.").source("");
    is.output("held", &Out::held, "");
  }
  Out run(const In&, const Params&, Context&) const { return {}; }
};

struct Take : WholeStep {
  struct In {
    One<Held> held;
  };
  struct Params {
    std::string name = "somebody";
  };
  struct Out {
    toy::Metrics metrics;
  };
  static void describe(Declaration<Take>& is) {
    is.name("test.take").version(1).summary("Takes.").source("");
    is.param("name", &Params::name).doc("who takes");
    is.input("held", &In::held, "").output("metrics", &Out::metrics, "");
  }
  Out run(const In&, const Params&, Context&) const {
    return {toy::Metrics().add("alive", Held::alive > 0 ? 1 : 0, "")};
  }
};

struct Look : WholeStep {
  struct In {
    Several<toy::Metrics> taken;
  };
  struct Params {};
  struct Out {
    toy::Metrics metrics;
  };
  static void describe(Declaration<Look>& is) {
    is.name("test.look").version(1).summary("Looks.").source("");
    is.input("taken", &In::taken, "").output("metrics", &Out::metrics, "");
  }
  Out run(const In&, const Params&, Context&) const {
    return {toy::Metrics().add("alive", Held::alive, "")};
  }
};

TEST(Release, ComesWithTheLastOfSeveralTakersThatRunAtTheSameTime) {
  static const StepOf<Give> give;
  static const StepOf<Take> take;
  static const StepOf<Look> look;
  Registry steps = engine_test::registry();
  for (const Step* step : std::initializer_list<const Step*>{&give, &take, &look}) steps.add(*step);
  const io::TestFolder folder;
  const Plan plan = read_pipeline(folder.write("held.yaml", R"(plumb: 1
name: held
steps:
  given: {use: test.give}
  a: {use: test.take, from: given, with: {name: a}}
  b: {use: test.take, from: given, with: {name: b}}
  c: {use: test.take, from: given, with: {name: c}}
  seen: {use: test.look, from: {taken: {a: a, b: b, c: c}}}
  out: {use: test.write, from: {metrics: {a: a, c: c, seen: seen}}}
)"),
                                  {}, steps);
  Observers silent;
  RunOptions options;
  for (int again = 0; again < 20; ++again)
    for (const unsigned threads : {1u, 2u, 8u}) {
      options.threads = threads;
      const RunResult result = run_plan(plan, steps, options, silent);
      ASSERT_EQ(result.documents.at(0).document->bytes.text(),
                "a alive=1\nc alive=1\nseen alive=0\n");
    }
  EXPECT_EQ(Held::alive, 0);
}

}  // namespace
}  // namespace plumb
