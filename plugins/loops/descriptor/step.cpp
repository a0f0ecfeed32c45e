#include "plumb/slam/step.hpp"

#include "descriptor.hpp"
#include "plumb/data/counted.hpp"
#include "plumb/data/short_number.hpp"
#include "plumb/plugin/module.hpp"
#include "similarity.hpp"

namespace plumb::loops_descriptor {
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
  struct Params {
    Similarity similarity = Similarity::inverse_difference;
    double epsilon = 1e-4;
    LoopOptions loops;
  };

  static void describe(Declaration<LoopEdges>& is) {
    is.name("loops.descriptor").version(1);
    is.summary("Proposes loop edges between segments whose descriptors are similar.");
    is.source("[Tang2024] 2.3.1, eq. 1, fig. 1");
    is.input("descriptors", &In::descriptors, "one vector per segment");
    is.input("segments", &In::segments, "the clouds, for their centroids");
    is.input("poses", &In::poses, "the current poses of the segments");
    is.scale(&In::scale);
    is.output("edges", &Out::edges, "loop edges; the score is the similarity");
    is.choice("similarity", &Params::similarity,
              {{"inverse_difference", Similarity::inverse_difference,
                "eq. 1, bounded where bins agree"},
               {"equation_1", Similarity::equation_1,
                "eq. 1 as printed, no difference less than 'epsilon', times a constant"},
               {"cosine", Similarity::cosine, "cosine of the angle between the vectors"},
               {"chi_square", Similarity::chi_square, "1 - chi-square distance of the histograms"}})
        .doc("how two descriptors are compared");
    is.param("epsilon", &Params::epsilon)
        .range(1e-9, 1)
        .doc(
            "difference of two bins that counts as agreement; for inverse_difference and "
            "equation_1");
    is.params(&Params::loops);
  }

  Out run(const In& in, const Params& params, Context& context) const {
    const std::size_t count = in.segments.size();
    if (in.descriptors.size() != count || in.poses->size() != count)
      throw Error("got " + counted(count, "segments") + ", " +
                  counted(in.descriptors.size(), "descriptors") + " and " +
                  counted(in.poses->size(), "poses") +
                  ": wire descriptors and poses of the same segments");
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
    Loops loops = find_loops(places, alike, params.loops);
    if (loops.edges.list.empty())
      context.warn("no loop found: no two segments with " +
                   short_number(loops.min_path_separation) +
                   " m of path between them are close and similar");
    context.count("loop edges", loops.edges.size());
    return {std::move(loops.edges)};
  }
};

}  // namespace
}  // namespace plumb::loops_descriptor

PLUMB_MODULE(plumb::loops_descriptor::LoopEdges)
