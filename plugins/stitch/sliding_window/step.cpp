#include "plumb/slam/step.hpp"

#include <optional>

#include "plumb/data/counted.hpp"
#include "plumb/plugin/module.hpp"
#include "shared/thinning/spots.hpp"
#include "window.hpp"

namespace plumb::stitch_sliding_window {
namespace {

struct SlidingWindow : WholeStep {
  struct In {
    Each<Segment> segments;
    One<Poses> poses;
    One<Edges> edges;
  };
  struct Out {
    std::vector<Segment> submaps;
  };
  struct Params {
    std::uint32_t frames = 10;
    std::uint32_t after = 0;
    std::optional<double> voxel_size;
    bool full_only = false;
  };

  static void describe(Declaration<SlidingWindow>& is) {
    is.name("stitch.sliding_window").version(2).source("[Zhang2023] 2, fig. 2-4");
    is.summary("Merges each scan with the scans before it into a submap.");
    is.input("segments", &In::segments, "the scans in order, one per segment");
    is.input("poses", &In::poses, "poses of the scans");
    is.optional_input("edges", &In::edges,
                      "the chain of accepted scans: only these are merged, and none from before a "
                      "window restarted");
    is.output("submaps", &Out::submaps,
              "for each scan the points of its window, in the scan's coordinates")
        .over("segments");
    is.param("frames", &Params::frames)
        .range(1, 10000)
        .doc("scans in a window, the newest included")
        .source("[Zhang2023] 2");
    is.param("after", &Params::after)
        .range(0, 10000)
        .doc("following scans that are merged too: for a refinement, when all scans are known");
    is.param("voxel_size", &Params::voxel_size)
        .unit("m")
        .range(0.001, 1000)
        .doc(
            "points this close to a kept point are merged with it into their mean; none: every "
            "point is kept");
    is.param("full_only", &Params::full_only)
        .doc("a window with fewer scans than 'frames', as at the start, gives an empty submap")
        .source("[Zhang2023] 2");
  }

  Out run(const In& in, const Params& params, Context& context) const {
    const std::size_t count = in.segments.size();
    if (in.poses->size() != count || (in.edges && in.edges->segments != count))
      throw Error("got " + counted(count, "segments") + ", " + counted(in.poses->size(), "poses") +
                  (in.edges ? " and edges between " + std::to_string(in.edges->segments) : "") +
                  "; wire those of the same segments");
    std::vector<One<Segment>> scans(count);
    context.parallel(count, [&](std::size_t k) { scans[k] = in.segments.open(k); });
    Windows windows =
        sliding_windows(count, in.edges ? &*in.edges : nullptr, params.frames, params.after);
    if (params.full_only) empty_short_ones(windows, params.frames);

    Out out;
    out.submaps.resize(count);
    context.parallel(count, [&](std::size_t k) {
      Cloud cloud = stitched(scans, *in.poses, windows, k, params.voxel_size);
      const std::size_t points = cloud.size();
      out.submaps[k] = scans[k]->with(std::move(cloud), std::vector<std::uint16_t>(points, 0));
    });
    return out;
  }

 private:
  static Cloud stitched(const std::vector<One<Segment>>& scans, const Poses& poses,
                        const Windows& windows, std::size_t k,
                        const std::optional<double>& voxel_size) {
    Cloud all;
    std::optional<thinning::Spots> spots;
    if (voxel_size) {
      spots.emplace(*voxel_size);
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
}  // namespace plumb::stitch_sliding_window

PLUMB_MODULE(plumb::stitch_sliding_window::SlidingWindow)
