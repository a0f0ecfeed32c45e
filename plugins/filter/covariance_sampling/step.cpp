#include "plumb/slam/step.hpp"

#include <cmath>

#include "covariance_sampling.hpp"
#include "plumb/plugin/module.hpp"

namespace plumb::filter_covariance_sampling {
namespace {

struct CovarianceSampling : SegmentStep {
  struct In {
    One<Segment> segment;
  };
  struct Out {
    Segment segment;
  };
  struct Params {
    double fraction = 0.3;
  };

  static void describe(Declaration<CovarianceSampling>& is) {
    is.name("filter.covariance_sampling").version(1);
    is.summary("Keeps the points that fix a registration best in all directions.");
    is.source("[Gelfand2003]; PCL, CovarianceSampling");
    is.input("segment", &In::segment, "a cloud with normals");
    is.output("segment", &Out::segment, "the points kept");
    is.param("fraction", &Params::fraction)
        .unit("%")
        .range(0, 1)
        .doc("share of the points that is kept");
  }

  Out run(const In& in, const Params& params, Context&) const {
    const Segment& segment = *in.segment;
    const auto size = static_cast<double>(segment.cloud.size());
    const auto count = static_cast<std::size_t>(std::lround(params.fraction * size));
    return {segment.selected(stable_points(segment.cloud, count))};
  }
};

}  // namespace
}  // namespace plumb::filter_covariance_sampling

PLUMB_MODULE(plumb::filter_covariance_sampling::CovarianceSampling)
