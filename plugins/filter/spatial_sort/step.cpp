#include "plumb/slam/step.hpp"

#include "hilbert.hpp"
#include "plumb/plugin/module.hpp"

namespace plumb::filter_spatial_sort {
namespace {

struct SpatialSort : SegmentStep {
  struct In {
    One<Segment> segment;
  };
  struct Out {
    Segment segment;
  };
  struct Params {};

  static void describe(Declaration<SpatialSort>& is) {
    is.name("filter.spatial_sort").version(1);
    is.summary("Puts the points in the order of a Hilbert curve: near in space, near in memory.");
    is.source("[Hilbert1891]; CGAL's Spatial Sorting");
    is.input("segment", &In::segment, "the cloud to sort");
    is.output("segment", &Out::segment, "the same points with all that is known of them");
  }

  Out run(const In& in, const Params&, Context&) const {
    return {in.segment->selected(hilbert_order(in.segment->cloud))};
  }
};

}  // namespace
}  // namespace plumb::filter_spatial_sort

PLUMB_MODULE(plumb::filter_spatial_sort::SpatialSort)
