/// Of the steps that test_steps.hpp offers those on edges and graphs, and what writes: they declare
/// ports and parameters like the real ones and do nothing.
#include "plumb/data/document.hpp"
#include "plumb/pipeline/testing/test_steps.hpp"
#include "plumb/plugin/toy_testing.hpp"

namespace plumb::test {
namespace {

using namespace toy;

struct Overlap : WholeStep {
  struct In {
    Each<Segment> segments;
    One<Poses> poses;
  };
  struct Out {
    Edges edges;
  };
  struct Params {
    std::optional<double> threshold;
    double margin = 0.9;
  };
  static void describe(Declaration<Overlap>& is) {
    is.name("edges.overlap");
    is.input("segments", &In::segments, "")
        .input("poses", &In::poses, "")
        .output("edges", &Out::edges, "");
    is.param("threshold", &Params::threshold).unit("%").range(0, 1).doc("least overlap");
    is.param("margin", &Params::margin).range(0, 1).doc("share of the smallest");
  }
  Out run(const In&, const Params&, Context&) const { return {}; }
};

struct Union : WholeStep {
  struct In {
    Several<Edges> edges;
  };
  struct Out {
    Edges edges;
  };
  struct Params {};
  static void describe(Declaration<Union>& is) {
    is.name("edges.union");
    is.input("edges", &In::edges, "").output("edges", &Out::edges, "");
  }
  Out run(const In&, const Params&, Context&) const { return {}; }
};

struct Mutual : EdgeStep {
  struct In {
    OverEdges edges;
    Ends<Features> features;
  };
  struct Out {
    Matches matches;
  };
  struct Params {};
  static void describe(Declaration<Mutual>& is) {
    is.name("match.fpfh_mutual");
    is.input("edges", &In::edges, "")
        .input("features", &In::features, "")
        .output("matches", &Out::matches, "");
  }
  Out run(const In&, const Params&, Context&) const { return {}; }
};

struct PruneDistance : EdgeStep {
  struct In {
    One<Matches> matches;
    Relative poses;
    ThisEdge edges;
    One<Metrics> scale;
  };
  struct Out {
    Matches matches;
  };
  struct Params {
    double max = 2;
  };
  static void describe(Declaration<PruneDistance>& is) {
    is.name("prune.distance");
    is.input("matches", &In::matches, "")
        .input("poses", &In::poses, "")
        .optional_input("edges", &In::edges, "")
        .scale(&In::scale);
    is.output("matches", &Out::matches, "");
    is.param("max", &Params::max).unit("m").range(0, 1000).doc("farthest apart");
  }
  Out run(const In&, const Params&, Context&) const { return {}; }
};

struct PruneKmeans : EdgeStep {
  struct In {
    One<Matches> matches;
    Relative poses;
  };
  struct Out {
    Matches matches;
  };
  struct Params {
    int clusters = 3;
  };
  static void describe(Declaration<PruneKmeans>& is) {
    is.name("prune.kmeans");
    is.input("matches", &In::matches, "")
        .input("poses", &In::poses, "")
        .output("matches", &Out::matches, "");
    is.param("clusters", &Params::clusters).range(1, 20).doc("how many");
  }
  Out run(const In&, const Params&, Context&) const { return {}; }
};

struct PruneRansac : EdgeStep {
  struct In {
    One<Matches> matches;
  };
  struct Out {
    Matches matches;
  };
  struct Params {
    double inlier = 0.5;
    int iterations = 1000;
  };
  static void describe(Declaration<PruneRansac>& is) {
    is.name("prune.ransac");
    is.input("matches", &In::matches, "").output("matches", &Out::matches, "");
    is.param("inlier", &Params::inlier).unit("m").range(0, 100).doc("distance");
    is.param("iterations", &Params::iterations).range(1, 1e6).doc("tries");
  }
  Out run(const In&, const Params&, Context&) const { return {}; }
};

struct Solve : WholeStep {
  enum class Loss { none, huber, cauchy };
  struct In {
    One<Poses> poses;
    Each<Matches> matches;
  };
  struct Out {
    Poses poses;
    Metrics metrics;
  };
  struct Params {
    Loss loss = Loss::huber;
    double share = 0.1;
  };
  static void describe(Declaration<Solve>& is) {
    is.name("solve.pose_graph");
    is.input("poses", &In::poses, "").optional_input("matches", &In::matches, "");
    is.output("poses", &Out::poses, "").output("metrics", &Out::metrics, "");
    is.choice("loss", &Params::loss,
              {{"none", Loss::none, "squares"},
               {"huber", Loss::huber, "Huber"},
               {"cauchy", Loss::cauchy, "Cauchy"}})
        .doc("what outliers cost");
    is.param("share", &Params::share).unit("%").range(0, 1).doc("of something");
  }
  Out run(const In&, const Params&, Context&) const { return {}; }
};

struct Rmse : WholeStep {
  struct In {
    One<Edges> edges;
    Each<Segment> segments;
    Several<Poses> poses;
    One<Poses> pairs;
  };
  struct Out {
    Metrics metrics;
  };
  struct Params {
    double cap = 0.5;
  };
  static void describe(Declaration<Rmse>& is) {
    is.name("measure.match_rmse");
    is.input("edges", &In::edges, "")
        .input("segments", &In::segments, "")
        .input("poses", &In::poses, "")
        .optional_input("pairs", &In::pairs, "");
    is.output("metrics", &Out::metrics, "");
    is.param("cap", &Params::cap).unit("m").range(0, 100).doc("pairs farther apart do not count");
  }
  Out run(const In&, const Params&, Context&) const { return {}; }
};

/// Its groups belong to the segments that it takes.
struct Stitch : WholeStep {
  struct In {
    Each<Segment> segments;
    One<Poses> poses;
  };
  struct Out {
    std::vector<Segment> groups;
  };
  struct Params {};
  static void describe(Declaration<Stitch>& is) {
    is.name("stitch.sliding_window");
    is.input("segments", &In::segments, "").input("poses", &In::poses, "");
    is.output("groups", &Out::groups, "").over("segments");
  }
  Out run(const In&, const Params&, Context&) const { return {}; }
};

struct Icp : EdgeStep {
  struct In {
    OverEdges edges;
    Ends<Segment> targets, sources;
  };
  struct Out {
    Registration registration;
  };
  struct Params {};
  static void describe(Declaration<Icp>& is) {
    is.name("register.icp");
    is.input("edges", &In::edges, "")
        .input("targets", &In::targets, "")
        .input("sources", &In::sources, "");
    is.output("registration", &Out::registration, "");
  }
  Out run(const In&, const Params&, Context&) const { return {}; }
};

struct ApplyChain : WholeStep {
  struct In {
    Each<Registration> registrations;
  };
  struct Out {
    Metrics metrics;
  };
  struct Params {};
  static void describe(Declaration<ApplyChain>& is) {
    is.name("apply.chain");
    is.input("registrations", &In::registrations, "").output("metrics", &Out::metrics, "");
  }
  Out run(const In&, const Params&, Context&) const { return {}; }
};

struct WriteTrajectory : WholeStep {
  struct In {
    One<Trajectory> trajectory;
  };
  struct Out {
    Document document;
  };
  struct Params {
    std::string name = "trajectory.tum";
  };
  static void describe(Declaration<WriteTrajectory>& is) {
    is.name("write.trajectory");
    is.input("trajectory", &In::trajectory, "").output("document", &Out::document, "");
    is.param("name", &Params::name).doc("of the file");
  }
  Out run(const In&, const Params&, Context&) const { return {}; }
};

}  // namespace

void add_graph_steps(Registry& registry) {
  static const StepOf<Overlap> overlap;
  static const StepOf<Union> edges_union;
  static const StepOf<Mutual> mutual;
  static const StepOf<PruneDistance> prune_distance;
  static const StepOf<PruneKmeans> kmeans;
  static const StepOf<PruneRansac> ransac;
  static const StepOf<Solve> solve;
  static const StepOf<Rmse> rmse;
  static const StepOf<Stitch> stitch;
  static const StepOf<Icp> icp;
  static const StepOf<ApplyChain> chain;
  static const StepOf<WriteTrajectory> write;
  for (const Step* step :
       std::initializer_list<const Step*>{&overlap, &edges_union, &mutual, &prune_distance, &kmeans,
                                          &ransac, &solve, &rmse, &stitch, &icp, &chain, &write})
    registry.add(*step);
}

const Registry& registry() {
  static const Registry all = [] {
    Registry made;
    add_cloud_steps(made);
    add_graph_steps(made);
    return made;
  }();
  return all;
}

}  // namespace plumb::test
