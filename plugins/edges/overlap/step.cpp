#include "plumb/slam/step.hpp"

#include "plumb/plugin/module.hpp"
#include "shared/overlapping/neighbours.hpp"
#include "voxels.hpp"

namespace plumb::edges_overlap {
namespace {

struct OverlapEdges : WholeStep {
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

  static void describe(Declaration<OverlapEdges>& is) {
    is.name("edges.overlap").version(1);
    is.summary(
        "Proposes edges between segments whose clouds overlap, and between consecutive ones.");
    is.source("[Tang2024] 2.3.1");
    is.input("segments", &In::segments, "the clouds");
    is.input("poses", &In::poses, "the current poses of the segments");
    is.scale(&In::scale);
    is.output("edges", &Out::edges, "sequential edges, and neighbours; the score is the overlap");
    is.params(&Params::overlap);
  }

  Out run(const In& in, const Params& params, Context& context) const {
    std::vector<Voxels> voxels(in.segments.size());
    const overlapping::Comparison by_voxels = {
        [&](std::size_t k, const Cloud& cloud, const Pose& T_world_segment,
            const Lattice& lattice) { voxels[k] = voxels_of(cloud, T_world_segment, lattice); },
        [&](std::size_t i, std::size_t j, double least) {
          return overlap(voxels[i], voxels[j], least);
        }};
    return {overlapping::propose(
        in.segments.size(), [&](std::size_t k) { return in.segments.open(k).shared(); }, *in.poses,
        params.overlap, by_voxels, context)};
  }
};

}  // namespace
}  // namespace plumb::edges_overlap

PLUMB_MODULE(plumb::edges_overlap::OverlapEdges)
