#include <optional>

#include "plumb/geometry/spots.hpp"
#include "plumb/plugin/module.hpp"
#include "window.hpp"

namespace plumb {
namespace {

struct SlidingWindow : WholeStep {
  struct In {
    Each<Segment> segments;
    One<Poses> poses;
    One<Edges> edges;
  };
  struct Out {
    std::vector<Segment> groups;
  };
  struct Params {
    std::uint32_t frames = 10;
    std::uint32_t after = 0;
    std::optional<double> leaf;
  };

  static void describe(Declaration<SlidingWindow>& is) {
    is.name("stitch.sliding_window").version(2).source("[Zhang2023] 2, fig. 2-4");
    is.summary("Stitches each scan with those before it into one group of points.");
    is.input("segments", &In::segments, "the scans in order, one a segment");
    is.input("poses", &In::poses, "where the scans are");
    is.optional_input("edges", &In::edges,
                      "the chain of accepted scans: only these take part, and none from before a "
                      "window started again");
    is.output("groups", &Out::groups,
              "for each scan its window's points, in the scan's coordinates")
        .over("segments");
    is.param("frames", &Params::frames)
        .range(1, 10000)
        .doc("scans in a window, the newest included")
        .source("[Zhang2023] 2");
    is.param("after", &Params::after)
        .range(0, 10000)
        .doc("following scans that also take part: for a refinement, when all is known");
    is.param("leaf", &Params::leaf)
        .unit("m")
        .range(0.001, 1000)
        .doc(
            "points so near to one that is kept become one with it, their mean; none: every point "
            "stays");
  }

  Out run(const In& in, const Params& params, Context& context) const {
    const std::size_t count = in.segments.size();
    if (in.poses->size() != count || (in.edges && in.edges->segments != count))
      throw Error("there are " + std::to_string(count) + " segments, " +
                  std::to_string(in.poses->size()) + " poses" +
                  (in.edges ? " and edges between " + std::to_string(in.edges->segments) : "") +
                  "; wire those of the same segments");
    std::vector<One<Segment>> scans(count);
    context.parallel(count, [&](std::size_t k) { scans[k] = in.segments.open(k); });
    const Windows windows =
        sliding_windows(count, in.edges ? &*in.edges : nullptr, params.frames, params.after);

    Out out;
    out.groups.resize(count);
    context.parallel(count, [&](std::size_t k) {
      Cloud cloud = stitched(scans, *in.poses, windows, k, params.leaf);
      const std::size_t points = cloud.size();
      out.groups[k] = scans[k]->with(std::move(cloud), std::vector<std::uint16_t>(points, 0));
    });
    return out;
  }

 private:
  static Cloud stitched(const std::vector<One<Segment>>& scans, const Poses& poses,
                        const Windows& windows, std::size_t k, const std::optional<double>& leaf) {
    Cloud all;
    std::optional<Spots> spots;
    if (leaf) {
      spots.emplace(*leaf);
    } else {
      std::size_t points = 0;
      for (auto p = windows.first[k]; p < windows.end[k]; ++p)
        points += scans[windows.members[p]]->cloud.size();
      all.reserve(points);
    }
    for (auto p = windows.first[k]; p < windows.end[k]; ++p) {
      const std::uint32_t member = windows.members[p];
      const Cloud& scan = scans[member]->cloud;
      const Motion motion(poses.relative(k, member));
      for (std::size_t n = 0; n < scan.size(); ++n) {
        const Eigen::Vector3f point = motion * scan.point(n);
        if (spots)
          spots->add(point.x(), point.y(), point.z());
        else
          all.add(point);
      }
    }
    return spots ? spots->means<Cloud>() : all;
  }
};

}  // namespace
}  // namespace plumb

PLUMB_MODULE(plumb::SlidingWindow)
