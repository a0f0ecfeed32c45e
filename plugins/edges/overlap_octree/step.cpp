#include "plumb/slam/step.hpp"

#include <optional>

#include "octree.hpp"
#include "plumb/plugin/module.hpp"
#include "shared/overlapping/neighbours.hpp"

namespace plumb::edges_overlap_octree {
namespace {

struct OctreeOverlapEdges : WholeStep {
  struct In {
    Each<Segment> segments;
    One<Poses> poses;
    One<Metrics> scale;
  };
  struct Out {
    Edges edges;
  };
  struct Params {
    overlapping::OverlapOptions overlap;
  };

  static void describe(Declaration<OctreeOverlapEdges>& is) {
    is.name("edges.overlap_octree").version(1);
    is.summary("Proposes edges between segments whose clouds overlap in CGAL's octrees.");
    is.source("[Tang2024] 2.3.1");
    is.input("segments", &In::segments, "the clouds");
    is.input("poses", &In::poses, "the current poses of the segments");
    is.scale(&In::scale);
    is.output("edges", &Out::edges, "sequential edges, and neighbours; the score is the overlap");
    is.params(&Params::overlap);
  }

  Out run(const In& in, const Params& params, Context& context) const {
    std::vector<std::optional<CloudOctree>> trees(in.segments.size());
    const overlapping::Comparison by_octrees = {
        [&](std::size_t k, const Cloud& cloud, const Pose& T_world_segment,
            const overlapping::Lattice& lattice) {
          trees[k].emplace(cloud, T_world_segment, lattice);
        },
        [&](std::size_t i, std::size_t j, double) { return overlap(*trees[i], *trees[j]); }};
    return {overlapping::propose(
        in.segments.size(), [&](std::size_t k) { return in.segments.open(k).shared(); }, *in.poses,
        params.overlap, by_octrees, context)};
  }
};

}  // namespace
}  // namespace plumb::edges_overlap_octree

PLUMB_MODULE(plumb::edges_overlap_octree::OctreeOverlapEdges)
