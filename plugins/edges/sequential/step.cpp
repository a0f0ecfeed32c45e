#include "plumb/slam/step.hpp"

#include "plumb/plugin/module.hpp"
#include "sequential.hpp"

namespace plumb::edges_sequential {
namespace {

struct SequentialEdges : WholeStep {
  struct In {
    Each<FrameRange> ranges;
  };
  struct Out {
    Edges edges;
  };
  struct Params {};

  static void describe(Declaration<SequentialEdges>& is) {
    is.name("edges.sequential")
        .version(1)
        .summary("Proposes an edge from every segment to the next one.");
    is.source("[Tang2024] 2.3.1");
    is.input("ranges", &In::ranges, "the frames and poses of the segments");
    is.output("edges", &Out::edges, "one edge fewer than there are segments");
  }

  Out run(const In& in, const Params&, Context& context) const {
    std::vector<Eigen::Vector3d> positions;
    for (std::size_t k = 0; k < in.ranges.size(); ++k)
      positions.push_back(in.ranges.open(k)->T_world_segment.translation);
    if (positions.size() < 2) context.warn("there are fewer than two segments: nothing to join");
    return {sequential_edges(positions)};
  }
};

}  // namespace
}  // namespace plumb::edges_sequential

PLUMB_MODULE(plumb::edges_sequential::SequentialEdges)
