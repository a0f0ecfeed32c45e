#include "plumb/slam/step.hpp"

#include <cmath>

#include "normal_space.hpp"
#include "plumb/plugin/module.hpp"

namespace plumb::filter_normal_space {
namespace {

struct NormalSpace : SegmentStep {
  struct In {
    One<Segment> segment;
  };
  struct Out {
    Segment segment;
  };
  struct Params {
    double fraction = 0.3;
    std::uint32_t bins = 8;
  };

  static void describe(Declaration<NormalSpace>& is) {
    is.name("filter.normal_space").version(1);
    is.summary("Keeps points so that all directions of normals are there alike.");
    is.source("[Rusinkiewicz2001] 3.1; PCL, NormalSpaceSampling");
    is.input("segment", &In::segment, "a cloud with normals");
    is.output("segment", &Out::segment, "the points kept");
    is.param("fraction", &Params::fraction)
        .unit("%")
        .range(0, 1)
        .doc("share of the points that is kept");
    is.param("bins", &Params::bins)
        .range(2, 32)
        .doc("parts that each of the normals' coordinates is cut into, from -1 to 1");
  }

  Out run(const In& in, const Params& params, Context& context) const {
    const Segment& segment = *in.segment;
    const auto size = static_cast<double>(segment.cloud.size());
    const auto count = static_cast<std::size_t>(std::lround(params.fraction * size));
    const auto seed = static_cast<std::uint32_t>(Random(context.seed()).next());
    return {segment.selected(alike_in_normals(segment.cloud, count, params.bins, seed))};
  }
};

}  // namespace
}  // namespace plumb::filter_normal_space

PLUMB_MODULE(plumb::filter_normal_space::NormalSpace)
