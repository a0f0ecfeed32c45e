/// Steps that do what no step should, for one edge, so that tests see what becomes of the others.
#include "plumb/slam/step.hpp"

#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <limits>
#include <vector>

#include "plumb/plugin/module.hpp"

namespace plumb {
namespace {

enum class Deed {
  nothing,
  segfault,
  abort,
  loop,
  error,
  odd,
  terabyte,
  eat,
  nan,
  leave,
  killed,
  exit,
  quick_exit
};

volatile int* volatile nowhere = nullptr;

void commit(Deed deed) {
  switch (deed) {
    case Deed::nothing:
    case Deed::nan:
      return;
    case Deed::segfault:
      *nowhere = 1;
      return;
    case Deed::abort:
      std::abort();
    case Deed::loop:
      for (volatile unsigned n = 0;;) n = n + 1;
    case Deed::error:
      throw Error("this edge is not to its liking");
    case Deed::odd:
      throw 42;  // NOLINT: what a careless author may throw
    case Deed::terabyte: {
      std::vector<char> much(std::size_t{1} << 40);
      throw Error("got a terabyte" + std::to_string(much.back()));
    }
    case Deed::eat:
      for (std::vector<std::vector<char>> much;;) much.emplace_back(std::size_t{1} << 24, 'x');
    case Deed::leave:
      _exit(7);
    case Deed::killed:
      raise(SIGKILL);
      return;
    case Deed::exit:
      std::exit(0);
    case Deed::quick_exit:
      std::quick_exit(0);
  }
}

struct Misbehave : EdgeStep {
  struct In {
    OverEdges edges;
    ThisEdge edge;
    One<Matches> matches;
  };
  struct Out {
    Matches matches;
  };
  struct Params {
    Deed deed = Deed::nothing;
    int from = 1;  ///< segment at which the edge begins
    int to = 2;
  };
  static void describe(Declaration<Misbehave>& is) {
    is.name("test.misbehave").version(1).summary("Passes matches on, but for one edge.");
    is.choice("deed", &Params::deed,
              {{"nothing", Deed::nothing, ""},
               {"segfault", Deed::segfault, ""},
               {"abort", Deed::abort, ""},
               {"loop", Deed::loop, ""},
               {"error", Deed::error, ""},
               {"odd", Deed::odd, ""},
               {"terabyte", Deed::terabyte, ""},
               {"eat", Deed::eat, ""},
               {"nan", Deed::nan, ""},
               {"leave", Deed::leave, ""},
               {"killed", Deed::killed, ""},
               {"exit", Deed::exit, ""},
               {"quick_exit", Deed::quick_exit, ""}})
        .doc("what it does");
    is.param("from", &Params::from).doc("the edge's first segment");
    is.param("to", &Params::to).doc("the edge's second segment");
    is.input("edges", &In::edges, "edges")
        .input("edge", &In::edge, "the edge")
        .input("matches", &In::matches, "matches");
    is.output("matches", &Out::matches, "the same");
  }
  Out run(const In& in, const Params& params, Context& context) const {
    context.count("matches passed on", in.matches->size());
    Matches matches = *in.matches;
    if (static_cast<int>(in.edge.edge.i) != params.from ||
        static_cast<int>(in.edge.edge.j) != params.to)
      return {matches};
    commit(params.deed);
    if (params.deed == Deed::nan && matches.size() > 0)
      matches.p[0].x() = std::numeric_limits<float>::quiet_NaN();
    return {matches};
  }
};

/// A solver that does the same.
struct MisSolve : WholeStep {
  struct In {
    One<Poses> poses;
  };
  struct Out {
    Poses poses;
  };
  struct Params {
    Deed deed = Deed::nothing;
  };
  static void describe(Declaration<MisSolve>& is) {
    is.name("test.missolve").version(1).summary("Passes poses on, or not.");
    is.choice("deed", &Params::deed,
              {{"nothing", Deed::nothing, ""},
               {"segfault", Deed::segfault, ""},
               {"nan", Deed::nan, ""},
               {"exit", Deed::exit, ""}})
        .doc("what it does");
    is.input("poses", &In::poses, "poses").output("poses", &Out::poses, "the same");
  }
  Out run(const In& in, const Params& params, Context&) const {
    commit(params.deed);
    Out out{*in.poses};
    if (params.deed == Deed::nan)
      out.poses.T_world_segment.back().translation.y() = std::numeric_limits<double>::quiet_NaN();
    return out;
  }
};

}  // namespace
}  // namespace plumb

PLUMB_MODULE(plumb::Misbehave, plumb::MisSolve)
