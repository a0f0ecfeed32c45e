#include "plumb/plugin/module.hpp"
#include "statistical_outlier.hpp"

namespace plumb {
namespace {

struct StatisticalOutlier : SegmentStep {
  struct In {
    One<Segment> segment;
  };
  struct Out {
    Segment segment;
  };
  struct Params {
    std::uint32_t neighbours = 20;
    double deviations = 2;
  };

  static void describe(Declaration<StatisticalOutlier>& is) {
    is.name("filter.statistical_outlier").version(1).source("[Tang2024] 2.2, [Rusu2008] 3.1");
    is.summary("Drops points that are lonelier than the others.");
    is.input("segment", &In::segment, "the cloud to clean");
    is.output("segment", &Out::segment,
              "the points that have their neighbours as near as others have");
    is.param("neighbours", &Params::neighbours)
        .range(1, 1000)
        .doc("nearest points whose mean distance counts");
    is.param("deviations", &Params::deviations)
        .range(0, 100)
        .doc("standard deviations above the mean of all points from which on a point is dropped");
  }

  Out run(const In& in, const Params& params, Context& context) const {
    const Segment& segment = *in.segment;
    const auto means =
        mean_distances(segment.cloud, segment.tree(), params.neighbours,
                       [&](std::size_t n, const auto& body) { context.parallel(n, body); });
    const auto kept = not_beyond(means, params.deviations);
    if (kept.size() < means.size())
      context.count("lonely points dropped", means.size() - kept.size());
    return {segment.selected(kept)};
  }
};

}  // namespace
}  // namespace plumb

PLUMB_MODULE(plumb::StatisticalOutlier)
