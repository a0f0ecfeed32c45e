#include "plumb/slam/step.hpp"

#include <functional>
#include <optional>

#include "by_distance.hpp"
#include "plumb/plugin/module.hpp"
#include "plumb/slam/range.hpp"

namespace plumb::segment_by_distance {
namespace {

struct ByDistance : WholeStep {
  struct In {
    One<Trajectory> trajectory;
    One<Metrics> scale;
  };
  struct Out {
    std::vector<FrameRange> ranges;
    Poses poses;
  };
  struct Params {
    double length = 15;
    std::optional<std::uint32_t> max_frames;
    std::optional<double> max_rotation;
    std::optional<double> max_duration;
    std::optional<double> max_length;
    std::uint32_t max_segments = 1000;
    double phase = 0;
    std::string check() const {
      return max_length && *max_length < length
                 ? "max_length must not be smaller than length, from which it grows"
                 : "";
    }
  };

  static void describe(Declaration<ByDistance>& is) {
    is.name("segment.by_distance").version(2).source("[Tang2024] 2.2, by path instead of by count");
    is.summary("Cuts the trajectory into segments of equal path length.");
    is.input("trajectory", &In::trajectory, "the poses of all frames");
    is.scale(&In::scale);
    is.output("ranges", &Out::ranges, "the frames of each segment");
    is.output("poses", &Out::poses, "pose of each segment: that of its middle frame");
    is.param("length", &Params::length)
        .unit("m")
        .range(0.01, 1e6)
        .doc("path length from a segment's first frame to its last, at most");
    is.param("max_frames", &Params::max_frames)
        .range(1, 65535)
        .doc("frames per segment, for where the sensor rests; none: no limit");
    is.param("max_rotation", &Params::max_rotation)
        .unit("rad")
        .range(0.005 * deg, 180 * deg)
        .doc(
            "a frame whose rotation relative to its segment's first frame exceeds this begins a "
            "new segment; none: no limit");
    is.param("max_duration", &Params::max_duration)
        .unit("s")
        .range(1e-3, 1e6)
        .doc(
            "a frame this long or longer after its segment's first begins a new segment; none: no "
            "limit");
    is.param("max_length", &Params::max_length)
        .unit("m")
        .range(0.01, 1e6)
        .doc(
            "'length' grows up to this where the path would give more than 'max_segments'; none: "
            "it does not grow");
    is.param("max_segments", &Params::max_segments).range(1, 1e9).doc("see 'max_length'");
    is.param("phase", &Params::phase)
        .unit("%")
        .range(0, 0.5)
        .doc("share of 'length' by which the first segment is shorter, which moves all cuts");
  }

  Out run(const In& in, const Params& params, Context&) const {
    Out out;
    const auto& poses = in.trajectory->T_world_frame;
    std::function<bool(std::size_t, std::size_t)> breaks;
    if (params.max_rotation || params.max_duration)
      breaks = [&](std::size_t first, std::size_t k) {
        return (params.max_rotation &&
                angle(poses[first].inverse() * poses[k]) > *params.max_rotation) ||
               (params.max_duration && later(*in.trajectory, first, k, *params.max_duration));
      };
    const auto path = travelled(*in.trajectory);
    const double length = grown_length(path.empty() ? 0 : path.back(), params.length,
                                       params.max_length, params.max_segments);
    out.ranges = ranges_from(
        *in.trajectory, starts_by_distance(path, length, params.max_frames, breaks, params.phase));
    out.poses = poses_of(out.ranges);
    return out;
  }

 private:
  /// Whether frame k comes at least `duration` [s] after the first one. Stamps are written to the
  /// microsecond, so that a second may come out a few of them short.
  static bool later(const Trajectory& trajectory, std::size_t first, std::size_t k,
                    double duration) {
    constexpr double rounding = 1e-5;
    return trajectory.stamps[k] - trajectory.stamps[first] >= duration - rounding;
  }
};

}  // namespace
}  // namespace plumb::segment_by_distance

PLUMB_MODULE(plumb::segment_by_distance::ByDistance)
