#include <functional>
#include <numbers>
#include <optional>

#include "by_distance.hpp"
#include "plumb/data/range.hpp"
#include "plumb/plugin/module.hpp"

namespace plumb {
namespace {

struct ByDistance : WholeStep {
  struct In {
    One<Trajectory> trajectory;
    One<Metrics> scale;
  };
  struct Out {
    std::vector<Range> ranges;
    Poses poses;
  };
  struct Params {
    double length = 15;
    std::optional<std::uint32_t> most_frames;
    std::optional<double> turn;
    std::optional<double> max_length;
    std::uint32_t max_segments = 1000;
    std::string check() const {
      return max_length && *max_length < length
                 ? "max_length must not be smaller than length, from which it grows"
                 : "";
    }
  };

  static void describe(Declaration<ByDistance>& is) {
    is.name("segment.by_distance").version(2).source("[Tang2024] 2.2, by path instead of by count");
    is.summary("Cuts the trajectory into segments of an equal length of path.");
    is.input("trajectory", &In::trajectory, "the poses of all frames");
    is.scale(&In::scale);
    is.output("ranges", &Out::ranges, "the frames of each segment");
    is.output("poses", &Out::poses, "where each segment is: the pose of its middle frame");
    is.param("length", &Params::length)
        .unit("m")
        .range(0.01, 1e6)
        .doc("path from a segment's first frame to its last, at most");
    is.param("most_frames", &Params::most_frames)
        .range(1, 65535)
        .doc("frames a segment at most, for where the sensor rests; none: no limit");
    is.param("turn", &Params::turn)
        .unit("rad")
        .range(1e-4, std::numbers::pi)
        .doc(
            "a frame that is turned by more against its segment's first begins a new one; none: "
            "however far");
    is.param("max_length", &Params::max_length)
        .unit("m")
        .range(0.01, 1e6)
        .doc(
            "'length' grows up to this where the path would give more than 'max_segments'; none: "
            "it does not grow");
    is.param("max_segments", &Params::max_segments).range(1, 1e9).doc("see 'max_length'");
  }

  Out run(const In& in, const Params& params, Context&) const {
    Out out;
    const auto& poses = in.trajectory->T_world_frame;
    std::function<bool(std::size_t, std::size_t)> turned;
    if (params.turn)
      turned = [&](std::size_t first, std::size_t k) {
        return angle(poses[first].inverse() * poses[k]) > *params.turn;
      };
    const auto path = travelled(*in.trajectory);
    const double length = grown_length(path.empty() ? 0 : path.back(), params.length,
                                       params.max_length, params.max_segments);
    out.ranges =
        ranges_from(*in.trajectory, starts_by_distance(path, length, params.most_frames, turned));
    out.poses = poses_of(out.ranges);
    return out;
  }
};

}  // namespace
}  // namespace plumb

PLUMB_MODULE(plumb::ByDistance)
