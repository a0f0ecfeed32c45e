#include "plumb/slam/step.hpp"

#include "plumb/plugin/module.hpp"
#include "radius_outlier.hpp"

namespace plumb::filter_radius_outlier {
namespace {

struct RadiusOutlier : SegmentStep {
  struct In {
    One<Segment> segment;
    One<Metrics> scale;
  };
  struct Out {
    Segment segment;
  };
  struct Params {
    double radius = 1;
    std::uint32_t min_neighbours = 4;
  };

  static void describe(Declaration<RadiusOutlier>& is) {
    is.name("filter.radius_outlier").version(1).source("PCL, RadiusOutlierRemoval");
    is.summary("Removes points with too few others round them.");
    is.input("segment", &In::segment, "the cloud to filter");
    is.scale(&In::scale);
    is.output("segment", &Out::segment, "the cloud without outliers");
    is.param("radius", &Params::radius)
        .unit("m")
        .range(0.001, 100)
        .doc("distance within which other points count");
    is.param("min_neighbours", &Params::min_neighbours)
        .range(1, 100000)
        .doc("points with fewer others within the radius are removed");
  }

  Out run(const In& in, const Params& params, Context& context) const {
    const Segment& segment = *in.segment;
    const auto kept = not_alone(segment.cloud, params.radius, params.min_neighbours);
    if (kept.size() < segment.cloud.size())
      context.count("outliers removed", segment.cloud.size() - kept.size());
    return {segment.selected(kept)};
  }
};

}  // namespace
}  // namespace plumb::filter_radius_outlier

PLUMB_MODULE(plumb::filter_radius_outlier::RadiusOutlier)
