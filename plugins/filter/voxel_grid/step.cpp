#include "plumb/slam/step.hpp"

#include "plumb/plugin/module.hpp"
#include "voxel_grid.hpp"

namespace plumb::filter_voxel_grid {
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
    double voxel_size = 0.3;
  };

  static void describe(Declaration<VoxelGrid>& is) {
    is.name("filter.voxel_grid").version(1).source("[Tang2024] 2.2; the mean as in [Zhang2023] 2");
    is.summary("Downsamples a cloud to one point per voxel, the mean of its points.");
    is.input("segment", &In::segment, "the cloud to downsample");
    is.scale(&In::scale);
    is.output("segment", &Out::segment,
              "the means of the voxels, with intensity and normals where the cloud has them");
    is.param("voxel_size", &Params::voxel_size)
        .unit("m")
        .range(0.001, 1000)
        .doc("edge length of a voxel");
  }

  Out run(const In& in, const Params& params, Context& context) const {
    Thinned thinned = thin(*in.segment, params.voxel_size);
    if (thinned.dropped)
      context.count("points with a non-finite coordinate dropped", thinned.dropped);
    return {in.segment->with(std::move(thinned.cloud), std::move(thinned.frame))};
  }
};

}  // namespace
}  // namespace plumb::filter_voxel_grid

PLUMB_MODULE(plumb::filter_voxel_grid::VoxelGrid)
