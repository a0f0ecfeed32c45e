#include <optional>

#include "by_distance.hpp"
#include "plumb/data/range.hpp"
#include "plumb/plugin/module.hpp"

namespace plumb {
namespace {

struct ByDistance : WholeStep {
  struct In {
    One<Trajectory> trajectory;
  };
  struct Out {
    std::vector<Range> ranges;
    Poses poses;
  };
  struct Params {
    double length = 15;
    std::optional<std::uint32_t> most_frames;
  };

  static void describe(Declaration<ByDistance>& is) {
    is.name("segment.by_distance").version(1).source("[Tang2024] 2.2, by path instead of by count");
    is.summary("Cuts the trajectory into segments of an equal length of path.");
    is.input("trajectory", &In::trajectory, "the poses of all frames");
    is.output("ranges", &Out::ranges, "the frames of each segment");
    is.output("poses", &Out::poses, "where each segment is: the pose of its middle frame");
    is.param("length", &Params::length)
        .unit("m")
        .range(0.01, 1e6)
        .doc("path from a segment's first frame to its last, at most");
    is.param("most_frames", &Params::most_frames)
        .range(1, 65535)
        .doc("frames a segment at most, for where the sensor rests; none: no limit");
  }

  Out run(const In& in, const Params& params, Context&) const {
    Out out;
    out.ranges = ranges_from(*in.trajectory, starts_by_distance(travelled(*in.trajectory),
                                                                params.length, params.most_frames));
    out.poses = poses_of(out.ranges);
    return out;
  }
};

}  // namespace
}  // namespace plumb

PLUMB_MODULE(plumb::ByDistance)
