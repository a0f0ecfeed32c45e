#include "plumb/slam/step.hpp"

#include "plumb/plugin/module.hpp"
#include "statistical_outlier.hpp"

namespace plumb::filter_statistical_outlier {
namespace {

struct StatisticalOutlier : SegmentStep {
  struct In {
    One<Segment> segment;
  };
  struct Out {
    Segment segment;
  };
  struct Params {
    std::uint32_t mean_k = 20;
    double stddev_mul_thresh = 2;
  };

  static void describe(Declaration<StatisticalOutlier>& is) {
    is.name("filter.statistical_outlier").version(1).source("[Tang2024] 2.2, [Rusu2008] 3.1");
    is.summary("Removes points whose mean distance to their neighbours is unusually large.");
    is.input("segment", &In::segment, "the cloud to filter");
    is.output("segment", &Out::segment, "the cloud without outliers");
    is.param("mean_k", &Params::mean_k)
        .range(1, 1000)
        .doc("number of nearest neighbours over which a point's mean distance is taken");
    is.param("stddev_mul_thresh", &Params::stddev_mul_thresh)
        .range(0, 100)
        .doc(
            "points whose mean distance exceeds the mean of all points by more than this many "
            "standard deviations are removed");
  }

  Out run(const In& in, const Params& params, Context& context) const {
    const Segment& segment = *in.segment;
    const auto means =
        mean_distances(segment.cloud, segment.tree(), params.mean_k, parallel::on(context));
    const auto kept = not_beyond(means, params.stddev_mul_thresh);
    if (kept.size() < means.size()) context.count("outliers removed", means.size() - kept.size());
    return {segment.selected(kept)};
  }
};

}  // namespace
}  // namespace plumb::filter_statistical_outlier

PLUMB_MODULE(plumb::filter_statistical_outlier::StatisticalOutlier)
