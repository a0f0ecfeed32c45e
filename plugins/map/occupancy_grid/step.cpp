#include "plumb/slam/step.hpp"

#include <algorithm>

#include "occupancy.hpp"
#include "plumb/data/counted.hpp"
#include "plumb/plugin/module.hpp"

namespace plumb::map_occupancy_grid {
namespace {

struct OccupancyGrid : WholeStep {
  struct In {
    Each<Frame> frames;
    One<Trajectory> trajectory;
    Each<Segment> submaps;
    One<Poses> poses;
  };
  struct Out {
    GridMap map;
  };
  using Params = GridOptions;

  static void describe(Declaration<OccupancyGrid>& is) {
    is.name("map.occupancy_grid").version(1).source("[Moravec1985], [Hornung2013]");
    is.summary("Builds an occupancy grid from 2-D scans by ray casting.");
    is.optional_input("frames", &In::frames, "the scans");
    is.optional_input("trajectory", &In::trajectory, "the sensor's pose for each scan");
    is.optional_input("submaps", &In::submaps,
                      "submaps instead of scans, each as one scan seen from its own origin");
    is.optional_input("poses", &In::poses, "the poses of the submaps");
    is.output("map", &Out::map, "log odds of each cell; 0: unknown");
    is.param("resolution", &Params::resolution)
        .unit("m")
        .range(0.001, 10)
        .doc("edge length of a cell");
    is.param("hit", &Params::hit)
        .range(1e-3, 10)
        .doc("log odds that a scan adds to a cell in which a ray ends");
    is.param("miss", &Params::miss)
        .range(1e-3, 10)
        .doc("log odds that a scan subtracts from a cell that rays only cross");
    is.param("min_log_odds", &Params::min_log_odds)
        .range(-100, 0)
        .doc("lower bound of a cell's log odds");
    is.param("max_log_odds", &Params::max_log_odds)
        .range(0, 100)
        .doc("upper bound of a cell's log odds");
    is.param("max_range", &Params::max_range)
        .unit("m")
        .range(0.1, 1000)
        .doc("rays that end farther away are no hits; they clear the cells up to this distance");
  }

  Out run(const In& in, const Params& params, Context& context) const {
    const bool of_frames = in.frames && in.trajectory && !in.submaps && !in.poses;
    const bool of_submaps = in.submaps && in.poses && !in.frames && !in.trajectory;
    if (!of_frames && !of_submaps)
      throw Error("wire 'frames' and 'trajectory', or 'submaps' and 'poses'");
    const auto scans = of_frames ? drawn(in.frames, in.trajectory->T_world_frame, "frames", context)
                                 : drawn(in.submaps, in.poses->T_world_segment, "submaps", context);
    Out out{occupancy(scans, params, parallel::on(context))};
    const auto seen = [&](auto test) {
      return static_cast<std::uint64_t>(std::ranges::count_if(out.map.log_odds, test));
    };
    context.count("cells occupied", seen([](float v) { return v > 0; }));
    context.count("cells free", seen([](float v) { return v < 0; }));
    return out;
  }

 private:
  /// The clouds of frames or segments where their poses have them.
  template <class T>
  static std::vector<PlacedScan> drawn(const Each<T>& items, const std::vector<Pose>& poses,
                                       const char* what, Context& context) {
    if (items.size() != poses.size())
      throw Error("got " + counted(items.size(), what) + " but " + counted(poses.size(), "poses") +
                  "; wire poses of these " + what);
    std::vector<PlacedScan> scans(items.size());
    context.parallel(scans.size(),
                     [&](std::size_t k) { scans[k] = placed(items.open(k)->cloud, poses[k]); });
    return scans;
  }
};

}  // namespace
}  // namespace plumb::map_occupancy_grid

PLUMB_MODULE(plumb::map_occupancy_grid::OccupancyGrid)
