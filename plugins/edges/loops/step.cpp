#include "loops.hpp"
#include "plumb/data/short_number.hpp"
#include "plumb/plugin/module.hpp"
#include "similarity.hpp"

namespace plumb {
namespace {

struct LoopEdges : WholeStep {
  struct In {
    Each<Descriptor> descriptors;
    Each<Segment> segments;
    One<Poses> poses;
    One<Metrics> scale;
  };
  struct Out {
    Edges edges;
  };
  struct Params : LoopOptions {
    Similarity similarity = Similarity::inverse_difference;
    double epsilon = 1e-4;
  };

  static void describe(Declaration<LoopEdges>& is) {
    is.name("edges.loops").version(1);
    is.summary("Joins segments that show a place seen before.");
    is.source("[Tang2024] 2.3.1, eq. 1");
    is.input("descriptors", &In::descriptors, "one vector a segment, to tell what looks alike");
    is.input("segments", &In::segments, "the clouds, for their centroids");
    is.input("poses", &In::poses, "where the segments are at present");
    is.scale(&In::scale);
    is.output("edges", &Out::edges, "loop edges; the score is the similarity");
    is.choice("similarity", &Params::similarity,
              {{"inverse_difference", Similarity::inverse_difference,
                "eq. 1, guarded where bins agree"},
               {"cosine", Similarity::cosine, "of the angle between the vectors"},
               {"chi_square", Similarity::chi_square, "1 - chi-square distance of histograms"}})
        .doc("how alike two descriptors are");
    is.param("epsilon", &Params::epsilon)
        .range(1e-9, 1)
        .doc("difference of two bins that counts as agreement; for inverse_difference");
    // Params inherits these, so their members are named by the base.
    is.param("candidates", as_own(&LoopOptions::candidates))
        .range(1, 1000)
        .doc("so many nearest centroids are compared by similarity")
        .source("[Tang2024] 2.3.1");
    is.param("least_path_gap", as_own(&LoopOptions::least_path_gap))
        .unit("m")
        .range(0, 1e6)
        .doc("path between two passes at least; none: 4 x the median step from segment to segment");
    is.param("reach", as_own(&LoopOptions::reach))
        .unit("m")
        .range(0, 1e6)
        .doc("greatest distance of centroids without drift; none: 2 x the median step");
    is.param("drift", as_own(&LoopOptions::drift))
        .unit("%")
        .range(0, 1)
        .doc("expected drift, of the path between two passes; added to 'reach'");
    is.param("threshold", as_own(&LoopOptions::threshold))
        .range(0, 1)
        .doc("least similarity; none: 'relative_threshold' x the median of consecutive segments");
    is.param("relative_threshold", as_own(&LoopOptions::relative_threshold))
        .unit("%")
        .range(0, 10)
        .doc("see 'threshold'");
    is.param("loops_per_segment", as_own(&LoopOptions::loops_per_segment))
        .range(1, 1000)
        .doc("edges are added until both ends have so many");
  }

  Out run(const In& in, const Params& params, Context& context) const {
    const std::size_t count = in.segments.size();
    if (in.descriptors.size() != count || in.poses->size() != count)
      throw Error("there are " + std::to_string(count) + " segments, " +
                  std::to_string(in.descriptors.size()) + " descriptors and " +
                  std::to_string(in.poses->size()) +
                  " poses: wire descriptors and poses of the same segments");
    Places places{std::vector<Eigen::Vector3d>(count), std::vector<Eigen::Vector3d>(count)};
    std::vector<One<Descriptor>> descriptors(count);
    context.parallel(count, [&](std::size_t k) {
      const Pose& T_world_segment = in.poses->T_world_segment[k];
      places.positions[k] = T_world_segment.translation;
      places.centroids[k] = T_world_segment * in.segments.open(k)->centroid.cast<double>().eval();
      descriptors[k] = in.descriptors.open(k);
    });
    const auto alike = [&](std::uint32_t i, std::uint32_t j) {
      return similarity(descriptors[i]->values, descriptors[j]->values, params.similarity,
                        params.epsilon);
    };
    Loops loops = find_loops(places, alike, params);
    if (loops.edges.list.empty())
      context.warn("no loop found: no two segments with " + short_number(loops.least_path_gap) +
                   " m of path between them lie near each other and look alike");
    context.count("loop edges", loops.edges.size());
    return {std::move(loops.edges)};
  }

 private:
  template <class M>
  static M Params::*as_own(M LoopOptions::*member) {
    return static_cast<M Params::*>(member);
  }
};

}  // namespace
}  // namespace plumb

PLUMB_MODULE(plumb::LoopEdges)
