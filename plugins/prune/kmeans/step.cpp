#include <algorithm>

#include "kmeans.hpp"
#include "motion_vectors.hpp"
#include "plumb/plugin/module.hpp"

namespace plumb {
namespace {

enum class Vector { displacement, motion };

struct KMeans : EdgeStep {
  struct In {
    One<Matches> matches;
    Relative poses;
  };
  struct Out {
    Matches matches;
  };
  struct Params {
    Vector vector = Vector::displacement;
    double lever = 2;
    std::uint32_t pairs_per_cluster = 8;
    std::uint32_t most_clusters = 30;
    Keep keep = Keep::largest;
    double grain = 0.3;
    std::uint32_t fewest = 6;
  };

  static void describe(Declaration<KMeans>& is) {
    is.name("prune.kmeans").version(1);
    is.summary("Keeps the largest group of pairs that imply the same motion.");
    is.source("[Tang2024] 2.3.2, [Xiong2018]");
    is.input("matches", &In::matches, "the pairs to look at");
    is.input("poses", &In::poses, "where the segments are at present");
    is.output("matches", &Out::matches, "the pairs of one cluster");
    is.choice("vector", &Params::vector,
              {{"displacement", Vector::displacement, "p - q under the present poses"},
               {"motion", Vector::motion, "that, and the rotation between the points' normals"}})
        .doc("what a pair says of the motion");
    is.param("lever", &Params::lever)
        .unit("m")
        .range(0, 100)
        .doc("displacement that weighs as much as a rotation by 1 rad; for 'vector: motion'");
    is.param("pairs_per_cluster", &Params::pairs_per_cluster)
        .range(1, 1e6)
        .doc("there is one cluster, and at least two, for so many pairs");
    is.param("most_clusters", &Params::most_clusters)
        .range(2, 1000)
        .doc("but never more than these");
    is.choice("keep", &Params::keep,
              {{"largest", Keep::largest, "the cluster with the most pairs, as in the paper"},
               {"densest", Keep::densest, "the cluster with the most pairs for its spread"}})
        .doc("which cluster is kept");
    is.param("grain", &Params::grain)
        .unit("m")
        .range(0.001, 100)
        .doc("spread below which clusters count as equally tight; for 'keep: densest'");
    is.param("fewest", &Params::fewest)
        .range(2, 1e6)
        .doc("fewer pairs than this are kept as they are: they show no groups");
  }

  Out run(const In& in, const Params& params, Context& context) const {
    const Matches& matches = *in.matches;
    if (matches.size() < params.fewest) {
      if (matches.size() > 0) context.count("edges with too few pairs to group, kept whole", 1);
      return {matches};
    }
    const auto vectors = params.vector == Vector::displacement
                             ? displacements(matches, in.poses.T_i_j)
                             : motions(matches, in.poses.T_i_j, params.lever);
    const auto wanted = static_cast<std::uint32_t>(matches.size()) / params.pairs_per_cluster;
    const auto clusters =
        kmeans(vectors, std::clamp(wanted, 2u, params.most_clusters), Random(context.seed()));
    const auto kept = best_cluster(clusters, vectors, params.keep, params.grain, params.fewest);
    context.count("pairs dropped", matches.size() - kept.size());
    return {select(matches, kept)};
  }
};

}  // namespace
}  // namespace plumb

PLUMB_MODULE(plumb::KMeans)
