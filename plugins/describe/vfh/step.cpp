#include "plumb/slam/step.hpp"

#include "plumb/plugin/module.hpp"
#include "vfh.hpp"

namespace plumb::describe_vfh {
namespace {

struct DescribeVfh : SegmentStep {
  struct In {
    One<Segment> segment;
  };
  struct Out {
    Descriptor descriptor;
  };
  struct Params {
    VfhOptions vfh;
  };

  static void describe(Declaration<DescribeVfh>& is) {
    is.name("describe.vfh").version(1).source("[Rusu2010]; PCL, VFHEstimation");
    is.summary(
        "Computes the VFH descriptor of a whole segment (viewpoint feature histogram, 308 "
        "numbers).");
    is.input("segment", &In::segment, "a cloud with normals");
    is.output("descriptor", &Out::descriptor, "five histograms that sum to 1");
    is.params(&Params::vfh);
  }

  Out run(const In& in, const Params& params, Context& context) const {
    if (auto values = vfh(in.segment->cloud, params.vfh)) return {Descriptor{std::move(*values)}};
    context.warn("describe.vfh: segment of frames " + std::to_string(in.segment->range.first) +
                 " to " + std::to_string(in.segment->range.end) +
                 " (end left out) has fewer than three points with normals, or all in one place: "
                 "its descriptor is all zero.");
    return {Descriptor{std::vector<float>(vfh_size, 0.0f)}};
  }
};

}  // namespace
}  // namespace plumb::describe_vfh

PLUMB_MODULE(plumb::describe_vfh::DescribeVfh)
