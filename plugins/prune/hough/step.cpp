#include "plumb/slam/step.hpp"

#include "hough.hpp"
#include "plumb/data/error.hpp"
#include "plumb/plugin/module.hpp"

namespace plumb::prune_hough {
namespace {

enum class Frames { poses, local };

struct Hough : EdgeStep {
  struct In {
    One<Matches> matches;
    Relative poses;
    Ends<Segment> segments;
    One<Metrics> scale;
  };
  struct Out {
    Matches matches;
  };
  struct Params {
    Frames frames = Frames::poses;
    double lrf_radius = 2.5;
    HoughOptions hough;
    std::uint32_t min_pairs = 6;
  };

  static void describe(Declaration<Hough>& is) {
    is.name("prune.hough").version(1).source("[Tombari2010b]; PCL, Hough3DGrouping");
    is.summary("Keeps the pairs that vote for the same place of one segment in the other.");
    is.input("matches", &In::matches, "the pairs to test");
    is.input("poses", &In::poses, "the current poses of the segments");
    is.optional_input("segments", &In::segments, "the clouds; for 'frames: local'");
    is.scale(&In::scale);
    is.output("matches", &Out::matches, "the pairs of the bin with the most votes");
    is.choice("frames", &Params::frames,
              {{"poses", Frames::poses, "the axes of the segments under the current poses"},
               {"local", Frames::local, "local reference frames of the points, as of SHOT"}})
        .doc("by which frames a pair says where the other segment lies");
    is.param("lrf_radius", &Params::lrf_radius)
        .unit("m")
        .range(0.01, 100)
        .doc("radius of the neighbourhood that a local frame follows; for 'frames: local'");
    is.params(&Params::hough);
    is.param("min_pairs", &Params::min_pairs)
        .range(3, 1e6)
        .doc("fewer pairs than this are kept as they are: too few to vote");
  }

  Out run(const In& in, const Params& params, Context& context) const {
    const Matches& matches = *in.matches;
    if (params.frames == Frames::local && !in.segments)
      throw Error("'frames: local' needs the input 'segments': wire the clouds, or take 'poses'");
    if (matches.size() < params.min_pairs) {
      if (matches.size() > 0) context.count("edges with too few pairs to group, kept whole", 1);
      return {matches};
    }
    const PairFrames frames =
        params.frames == Frames::poses
            ? frames_of_pose(matches.size(), in.poses.T_i_j)
            : local_frames(matches, in.segments.i->cloud, in.segments.j->cloud, params.lrf_radius);
    const auto kept = most_voted(matches, frames, params.hough);
    context.count("pairs dropped", matches.size() - kept.size());
    if (kept.empty()) context.count("edges whose pairs vote for no place", 1);
    return {select(matches, kept)};
  }
};

}  // namespace
}  // namespace plumb::prune_hough

PLUMB_MODULE(plumb::prune_hough::Hough)
