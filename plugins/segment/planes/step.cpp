#include "plumb/slam/step.hpp"

#include "growing.hpp"
#include "plumb/data/error.hpp"
#include "plumb/plugin/module.hpp"

namespace plumb::segment_planes {
namespace {

/// The points on planes, each with its plane's normal, turned to where it was seen from.
Segment flattened(const Segment& segment, const Planes& planes) {
  std::vector<std::uint32_t> on_a_plane;
  for (std::uint32_t k = 0; k < planes.label.size(); ++k)
    if (planes.label[k] > 0) on_a_plane.push_back(k);
  Segment result = segment.selected(on_a_plane);
  Cloud& cloud = result.cloud;
  for (std::size_t n = 0; n < on_a_plane.size(); ++n) {
    Eigen::Vector3f normal = planes.planes[planes.label[on_a_plane[n]] - 1].normal;
    if (normal.dot(result.origin(n) - cloud.point(n)) < 0) normal = -normal;
    cloud.nx[n] = normal.x(), cloud.ny[n] = normal.y(), cloud.nz[n] = normal.z();
  }
  return result;
}

struct SegmentPlanes : SegmentStep {
  struct In {
    One<Segment> segment;
    One<Metrics> scale;
  };
  struct Out {
    Segment segment;
    Planes planes;
  };
  struct Params {
    GrowingOptions growing;
  };

  static void describe(Declaration<SegmentPlanes>& is) {
    is.name("segment.planes").version(1);
    is.summary("Finds the planes of a cloud by region growing.");
    is.source("[Lafarge2012]; the order of the seeds is ours");
    is.input("segment", &In::segment, "a cloud with normals");
    is.scale(&In::scale);
    is.output("segment", &Out::segment, "the points that lie on planes, with the planes' normals");
    is.output("planes", &Out::planes, "the planes, and on which of them each point lies");
    is.params(&Params::growing);
  }

  Out run(const In& in, const Params& params, Context& context) const {
    const Segment& segment = *in.segment;
    if (!segment.cloud.empty() && !segment.cloud.has_normals())
      throw Error("the cloud has no normals: put estimate.normals before");
    Planes planes = grow_planes(segment, params.growing);
    Segment on_planes = flattened(segment, planes);
    context.count("planes", planes.planes.size());
    context.count("points on no plane dropped", segment.cloud.size() - on_planes.cloud.size());
    return {std::move(on_planes), std::move(planes)};
  }
};

}  // namespace
}  // namespace plumb::segment_planes

PLUMB_MODULE(plumb::segment_planes::SegmentPlanes)
