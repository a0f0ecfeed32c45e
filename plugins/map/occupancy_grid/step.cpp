#include "plumb/slam/step.hpp"

#include <algorithm>

#include "occupancy.hpp"
#include "plumb/plugin/module.hpp"

namespace plumb::map_occupancy_grid {
namespace {

/// The parameters, and the grid, of both steps.
template <class Self>
void describe_grid(Declaration<Self>& is) {
  is.param("resolution", &GridOptions::resolution)
      .unit("m")
      .range(0.001, 10)
      .doc("edge length of a cell");
  is.param("hit", &GridOptions::hit)
      .range(1e-3, 10)
      .doc("log odds that a scan adds to a cell in which a ray ends");
  is.param("miss", &GridOptions::miss)
      .range(1e-3, 10)
      .doc("log odds that a scan subtracts from a cell that rays only cross");
  is.param("min_log_odds", &GridOptions::min_log_odds)
      .range(-100, 0)
      .doc("lower bound of a cell's log odds");
  is.param("max_log_odds", &GridOptions::max_log_odds)
      .range(0, 100)
      .doc("upper bound of a cell's log odds");
  is.param("max_range", &GridOptions::max_range)
      .unit("m")
      .range(0.1, 1000)
      .doc("rays that end farther away are no hits; they clear the cells up to this distance");
}

/// The grid of the clouds of frames or segments, `items`, by their poses.
template <class T>
GridMap grid_of(const Each<T>& items, const std::vector<Pose>& poses, const GridOptions& options,
                Context& context) {
  std::vector<PlacedScan> scans(items.size());
  context.parallel(scans.size(),
                   [&](std::size_t k) { scans[k] = placed(items.open(k)->cloud, poses[k]); });
  GridMap map = occupancy(scans, options, parallel::on(context));
  const auto seen = [&](auto test) {
    return static_cast<std::uint64_t>(std::ranges::count_if(map.log_odds, test));
  };
  context.count("cells occupied", seen([](float v) { return v > 0; }));
  context.count("cells free", seen([](float v) { return v < 0; }));
  return map;
}

struct OccupancyGrid : WholeStep {
  struct In {
    Each<Frame> frames;
    One<Trajectory> trajectory;
  };
  struct Out {
    GridMap map;
  };
  using Params = GridOptions;

  static void describe(Declaration<OccupancyGrid>& is) {
    is.name("map.occupancy_grid").version(1).source("[Moravec1985], [Hornung2013]");
    is.summary("Builds an occupancy grid from 2-D scans by ray casting.");
    is.input("frames", &In::frames, "the scans");
    is.input("trajectory", &In::trajectory, "the sensor's pose for each scan");
    is.output("map", &Out::map, "log odds of each cell; 0: unknown");
    describe_grid(is);
  }

  Out run(const In& in, const Params& params, Context& context) const {
    require_pose_each(*in.trajectory, in.frames.size());
    return {grid_of(in.frames, in.trajectory->T_world_frame, params, context)};
  }
};

struct SubmapGrid : WholeStep {
  struct In {
    Each<Segment> submaps;
    One<Poses> poses;
  };
  struct Out {
    GridMap map;
  };
  using Params = GridOptions;

  static void describe(Declaration<SubmapGrid>& is) {
    is.name("map.submap_grid")
        .version(1)
        .source("[Zhang2023] 1 for submaps; [Moravec1985], [Hornung2013]");
    is.summary("Builds an occupancy grid from planar submaps, each drawn as one scan.");
    is.input("submaps", &In::submaps, "the submaps, seen from their own origins");
    is.input("poses", &In::poses, "the poses of the submaps");
    is.output("map", &Out::map, "log odds of each cell; 0: unknown");
    describe_grid(is);
  }

  Out run(const In& in, const Params& params, Context& context) const {
    require_pose_each(*in.poses, in.submaps.size());
    return {grid_of(in.submaps, in.poses->T_world_segment, params, context)};
  }
};

}  // namespace
}  // namespace plumb::map_occupancy_grid

PLUMB_MODULE(plumb::map_occupancy_grid::OccupancyGrid, plumb::map_occupancy_grid::SubmapGrid)
