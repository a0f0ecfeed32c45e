#pragma once
/// Small steps for tests of the engine: a source of numbered frames, merging, pairing, a loop that
/// halves.

#include <algorithm>
#include <atomic>
#include <cmath>

#include "plumb/data/document.hpp"
#include "plumb/plugin/registry.hpp"
#include "plumb/plugin/toy_testing.hpp"

namespace plumb::engine_test {

using namespace toy;

inline std::atomic<int> frames_opened{0}, pairs_made{0}, shifted_made{0};

/// n frames of one point, at k, in segments of 3.
struct Source : WholeStep {
  struct In {};
  struct Params {
    int frames = 12;
  };
  struct Out {
    Lazy<Frame> frames;
    std::vector<FrameRange> ranges;
    Poses poses;
  };
  static void describe(Declaration<Source>& is) {
    is.name("test.source").version(1).summary("Makes frames.").source("");
    is.param("frames", &Params::frames).range(3, 1000).doc("how many");
    is.output("frames", &Out::frames, "")
        .output("ranges", &Out::ranges, "")
        .output("poses", &Out::poses, "");
  }
  Out run(const In&, const Params& params, Context&) const {
    Out out;
    for (int k = 0; k < params.frames; ++k)
      out.frames.keys.push_back({0, static_cast<std::uint64_t>(k)});
    out.frames.open = [](std::size_t k, Context&) {
      ++frames_opened;
      return Frame{static_cast<std::uint32_t>(k), static_cast<float>(k)};
    };
    for (std::uint32_t first = 0; first < static_cast<std::uint32_t>(params.frames); first += 3) {
      out.ranges.push_back({first, std::min<std::uint32_t>(first + 3, params.frames)});
      out.poses.places.push_back(8.0 * first);
    }
    return out;
  }
};

/// A segment of a range with other points, all of its first frame.
inline Segment with(const FrameRange& range, std::vector<float> points) {
  const std::size_t size = points.size();
  return {range, std::move(points), std::vector<std::uint16_t>(size, 0)};
}

struct Keep : FrameStep {
  struct In {
    One<Frame> frame;
  };
  struct Params {
    int refuse = -1;
  };
  struct Out {
    Frame frame;
  };
  static void describe(Declaration<Keep>& is) {
    is.name("test.keep").version(1).summary("Passes frames on.").source("");
    is.param("refuse", &Params::refuse).doc("a frame that fails");
    is.input("frame", &In::frame, "").output("frame", &Out::frame, "");
  }
  Out run(const In& in, const Params& params, Context& context) const {
    if (static_cast<int>(in.frame->index) >= params.refuse && params.refuse >= 0)
      throw Error("will not");
    context.count("frames seen", 1);
    return {*in.frame};
  }
};

struct Merge : SegmentStep {
  struct In {
    Each<Frame> frames;
    One<FrameRange> range;
  };
  struct Params {};
  struct Out {
    Segment segment;
  };
  static void describe(Declaration<Merge>& is) {
    is.name("test.merge").version(1).summary("Merges frames.").source("");
    is.input("frames", &In::frames, "")
        .input("ranges", &In::range, "")
        .output("segment", &Out::segment, "");
  }
  Out run(const In& in, const Params&, Context&) const {
    std::vector<float> points;
    for (std::size_t k = 0; k < in.frames.size(); ++k) points.push_back(in.frames.open(k)->x);
    return {with(*in.range, std::move(points))};
  }
};

struct Chain : WholeStep {
  struct In {
    Each<Segment> segments;
  };
  struct Params {};
  struct Out {
    Edges edges;
  };
  static void describe(Declaration<Chain>& is) {
    is.name("test.chain").version(1).summary("Joins neighbours.").source("");
    is.input("segments", &In::segments, "").output("edges", &Out::edges, "");
  }
  Out run(const In& in, const Params&, Context&) const {
    Edges edges;
    edges.segments = static_cast<std::uint32_t>(in.segments.size());
    for (std::uint32_t k = 1; k < edges.segments; ++k) edges.list.push_back({k - 1, k});
    return {edges};
  }
};

/// Does not see poses: made once however many passes ask.
struct Pair : EdgeStep {
  struct In {
    OverEdges edges;
    Ends<Segment> segments;
  };
  struct Params {};
  struct Out {
    Matches matches;
  };
  static void describe(Declaration<Pair>& is) {
    is.name("test.pair").version(1).summary("Pairs first points.").source("");
    is.input("edges", &In::edges, "")
        .input("segments", &In::segments, "")
        .output("matches", &Out::matches, "");
  }
  Out run(const In& in, const Params&, Context&) const {
    ++pairs_made;
    Matches matches;
    matches.p = {in.segments.i->points.at(0)};
    matches.q = {in.segments.j->points.at(0)};
    return {matches};
  }
};

/// To each segment the points of the one before it; `lose` leaves out the last group.
struct Stitch : WholeStep {
  struct In {
    Each<Segment> segments;
  };
  struct Params {
    bool lose = false;
  };
  struct Out {
    std::vector<Segment> groups;
  };
  static void describe(Declaration<Stitch>& is) {
    is.name("test.stitch").version(1).summary("Stitches.").source("");
    is.param("lose", &Params::lose).doc("leave out the last");
    is.input("segments", &In::segments, "").output("groups", &Out::groups, "").over("segments");
  }
  Out run(const In& in, const Params& params, Context&) const {
    Out out;
    for (std::size_t k = 0; k + params.lose < in.segments.size(); ++k) {
      const auto piece = in.segments.open(k);
      std::vector<float> points;
      if (k > 0) points.push_back(in.segments.open(k - 1)->points.at(0));
      points.push_back(piece->points.at(0));
      out.groups.push_back(with(piece->range, std::move(points)));
    }
    return out;
  }
};

/// Two pairs that carry two numbers.
inline Matches noted(float first, float second) { return {{0, 0}, {0, 0}, {first, second}}; }

/// How far i's first target lies from j's first source.
struct Lay : EdgeStep {
  struct In {
    OverEdges edges;
    Ends<Segment> targets, sources;
  };
  struct Params {};
  struct Out {
    Matches matches;
  };
  static void describe(Declaration<Lay>& is) {
    is.name("test.lay").version(1).summary("Lays clouds on clouds.").source("");
    is.input("edges", &In::edges, "")
        .input("targets", &In::targets, "")
        .input("sources", &In::sources, "");
    is.output("matches", &Out::matches, "");
  }
  Out run(const In& in, const Params&, Context&) const {
    return {noted(std::abs(in.targets.i->points.at(0) - in.sources.j->points.at(0)), 0)};
  }
};

/// Sees its edge's shift: made anew when poses change.
struct Shift : EdgeStep {
  struct In {
    One<Matches> matches;
    Relative poses;
    ThisEdge edge;
  };
  struct Params {
    double gate = 1;
  };
  struct Out {
    Matches matches;
  };
  static void describe(Declaration<Shift>& is) {
    is.name("test.shift").version(1).summary("Notes the gap.").source("");
    is.param("gate", &Params::gate).unit("m").doc("noted as weight");
    is.input("matches", &In::matches, "")
        .input("poses", &In::poses, "")
        .optional_input("edges", &In::edge, "");
    is.output("matches", &Out::matches, "");
  }
  Out run(const In& in, const Params& params, Context&) const {
    ++shifted_made;
    return {noted(static_cast<float>(std::abs(in.poses.shift)), static_cast<float>(params.gate))};
  }
};

/// Halves all distances.
struct Halve : WholeStep {
  struct In {
    Each<Matches> matches;
    One<Poses> poses;
  };
  struct Params {};
  struct Out {
    Poses poses;
    Metrics metrics;
  };
  static void describe(Declaration<Halve>& is) {
    is.name("test.halve").version(1).summary("Halves.").source("");
    is.input("matches", &In::matches, "").input("poses", &In::poses, "");
    is.output("poses", &Out::poses, "").output("metrics", &Out::metrics, "");
  }
  Out run(const In& in, const Params&, Context&) const {
    Out out{*in.poses, {}};
    for (double& place : out.poses.places) place *= 0.5;
    double sum = 0, gates = 0;
    for (std::size_t k = 0; k < in.matches.size(); ++k) {
      sum += in.matches.open(k)->weight.at(0);
      gates += in.matches.open(k)->weight.at(1);
    }
    out.metrics.add("gap", sum, "m").add("gates", gates, "m");
    return out;
  }
};

struct Write : WholeStep {
  struct In {
    Several<Metrics> metrics;
    One<Poses> poses;
  };
  struct Params {
    std::string name = "gaps.txt";
  };
  struct Out {
    Document document;
  };
  static void describe(Declaration<Write>& is) {
    is.name("test.write").version(1).summary("Writes.").source("");
    is.param("name", &Params::name).doc("of the file");
    is.input("metrics", &In::metrics, "")
        .optional_input("poses", &In::poses, "")
        .output("document", &Out::document, "");
  }
  Out run(const In& in, const Params& params, Context&) const {
    Document document{params.name, ""};
    for (const auto& [label, metrics] : in.metrics) {
      document.bytes.append(label);
      for (const Number& number : metrics->numbers)
        document.bytes.append(" " + number.name + "=" + shortest(number.value));
      document.bytes.append("\n");
    }
    return {document};
  }
};

/// Sums the points' places, in order.
struct Sum : WholeStep {
  struct In {
    Each<Frame> frames;
  };
  struct Params {};
  struct Out {
    Metrics metrics;
  };
  static void describe(Declaration<Sum>& is) {
    is.name("test.sum").version(1).summary("Sums.").source("");
    is.input("frames", &In::frames, "").output("metrics", &Out::metrics, "");
  }
  Out run(const In& in, const Params&, Context&) const {
    double sum = 0;
    for (std::size_t k = 0; k < in.frames.size(); ++k)
      sum = 2 * sum + in.frames.open(k)->x;  // depends on the order
    const auto frames = static_cast<double>(in.frames.size());
    return {Metrics().add("sum", sum, "").add("frames", frames, "")};
  }
};

inline Registry registry() {
  static const StepOf<Source> source;
  static const StepOf<Keep> keep;
  static const StepOf<Merge> merge;
  static const StepOf<Chain> chain;
  static const StepOf<Pair> pair;
  static const StepOf<Stitch> stitch;
  static const StepOf<Lay> lay;
  static const StepOf<Shift> shift;
  static const StepOf<Halve> halve;
  static const StepOf<Write> write;
  static const StepOf<Sum> sum;
  Registry registry;
  for (const Step* step : std::initializer_list<const Step*>{
           &source, &keep, &merge, &chain, &pair, &stitch, &lay, &shift, &halve, &write, &sum})
    registry.add(*step);
  return registry;
}

/// The steps of a pipeline that uses them, up to what it writes: frames are merged and paired, and
/// a loop halves their shifts three times.
inline const std::string halving_steps = R"(steps:
  source: {use: test.source}
  kept: {use: test.keep, from: source.frames}
  merged: {use: test.merge, from: {frames: kept, ranges: source.ranges}}
  edges: {use: test.chain, from: merged}
  loop:
    repeat:
      passes: {gate: [4 m, 2 m, 1 m]}
      carry: {poses: solved}
    start: {poses: source.poses}
    steps:
      pairs: {use: test.pair, from: {edges: edges, segments: merged}}
      near: {use: test.shift, from: {matches: pairs, poses: poses, edges: edges}, with: {gate: $gate}}
      solved: {use: test.halve, from: {matches: near, poses: poses}}
)";

}  // namespace plumb::engine_test
