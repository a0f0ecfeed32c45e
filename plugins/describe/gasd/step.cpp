#include "plumb/slam/step.hpp"

#include "gasd.hpp"
#include "plumb/plugin/module.hpp"

namespace plumb::describe_gasd {
namespace {

struct DescribeGasd : SegmentStep {
  struct In {
    One<Segment> segment;
  };
  struct Out {
    Descriptor descriptor;
  };
  struct Params {
    Interpolation interpolation = Interpolation::quadrilinear;
  };

  static void describe(Declaration<DescribeGasd>& is) {
    is.name("describe.gasd").version(1).source("[Lima2016]; PCL, GASDEstimation");
    is.summary(
        "Computes the GASD descriptor of a whole segment (globally aligned spatial distribution, "
        "512 numbers).");
    is.input("segment", &In::segment, "the cloud");
    is.output("descriptor", &Out::descriptor, "shares of the points in 8 x 8 x 8 cells; sum 1");
    is.choice("interpolation", &Params::interpolation,
              {{"none", Interpolation::none, "each point counts in its cell"},
               {"quadrilinear", Interpolation::quadrilinear,
                "each point is shared out among the cells round it"}})
        .doc("how a point is counted")
        .source("PCL, HistogramInterpolationMethod");
  }

  Out run(const In& in, const Params& params, Context& context) const {
    if (auto values = gasd(in.segment->cloud, params.interpolation))
      return {Descriptor{std::move(*values)}};
    context.warn("describe.gasd: segment of frames " + std::to_string(in.segment->range.first) +
                 " to " + std::to_string(in.segment->range.end) +
                 " (end left out) has fewer than three points, or all in one place: its descriptor "
                 "is all zero.");
    return {Descriptor{std::vector<float>(gasd_size, 0.0f)}};
  }
};

}  // namespace
}  // namespace plumb::describe_gasd

PLUMB_MODULE(plumb::describe_gasd::DescribeGasd)
