#include "plumb/slam/step.hpp"

#include "esf.hpp"
#include "plumb/plugin/module.hpp"

namespace plumb::describe_esf {
namespace {

struct DescribeEsf : SegmentStep {
  struct In {
    One<Segment> segment;
  };
  struct Out {
    Descriptor descriptor;
  };
  struct Params {
    std::uint32_t samples = 20000;
    std::uint32_t seed = 0;
  };

  static void describe(Declaration<DescribeEsf>& is) {
    is.name("describe.esf").version(1);
    is.summary(
        "Computes the ESF descriptor of a whole segment (ensemble of shape functions, 640 "
        "numbers).");
    is.source("[Wohlkinger2011]; [Tang2024] 2.3.1");
    is.input("segment", &In::segment, "the cloud");
    is.output("descriptor", &Out::descriptor, "ten histograms of 64 bins that sum to 1");
    is.param("samples", &Params::samples)
        .range(100, 10000000)
        .doc(
            "random triples of points; the noise of the descriptor falls with the square root of "
            "their number");
    is.param("seed", &Params::seed).doc("another draw for each number; 0: by the inputs alone");
  }

  Out run(const In& in, const Params& params, Context& context) const {
    if (auto values = esf(in.segment->cloud, params.samples, reseeded(context.seed(), params.seed)))
      return {Descriptor{std::move(*values)}};
    context.warn(
        "describe.esf: segment of frames " + std::to_string(in.segment->range.first) + " to " +
        std::to_string(in.segment->range.end) +
        " (end left out) has no three points that span a triangle: its descriptor is all zero.");
    return {Descriptor{std::vector<float>(esf_size, 0.0f)}};
  }
};

}  // namespace
}  // namespace plumb::describe_esf

PLUMB_MODULE(plumb::describe_esf::DescribeEsf)
