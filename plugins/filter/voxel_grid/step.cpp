#include "plumb/plugin/module.hpp"
#include "voxel_grid.hpp"

namespace plumb {
namespace {

struct VoxelGrid : SegmentStep {
  struct In {
    One<Segment> segment;
    One<Metrics> scale;
  };
  struct Out {
    Segment segment;
  };
  struct Params {
    double leaf = 0.3;
  };

  static void describe(Declaration<VoxelGrid>& is) {
    is.name("filter.voxel_grid").version(1).source("[Tang2024] 2.2");
    is.summary("Keeps one point per cubic cell: the mean of the points in it.");
    is.input("segment", &In::segment, "the cloud to thin");
    is.scale(&In::scale);
    is.output("segment", &Out::segment,
              "its cells' means, with intensity and normals where it has them");
    is.param("leaf", &Params::leaf).unit("m").range(0.001, 1000).doc("edge length of a cell");
  }

  Out run(const In& in, const Params& params, Context& context) const {
    Thinned thinned = thin(*in.segment, params.leaf);
    if (thinned.dropped)
      context.count("points with a coordinate that is no number dropped", thinned.dropped);
    return {in.segment->with(std::move(thinned.cloud), std::move(thinned.frame))};
  }
};

}  // namespace
}  // namespace plumb

PLUMB_MODULE(plumb::VoxelGrid)
