#include "plumb/slam/step.hpp"

#include <algorithm>

#include "kmeans.hpp"
#include "motion_vectors.hpp"
#include "plumb/plugin/module.hpp"

namespace plumb::prune_kmeans {
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
    std::uint32_t max_clusters = 30;
    Keep keep = Keep::largest;
    double min_spread = 0.3;
    std::uint32_t min_pairs = 6;
    std::uint32_t seed = 0;
  };

  static void describe(Declaration<KMeans>& is) {
    is.name("prune.kmeans").version(1);
    is.summary("Clusters the pairs by the motion that they imply and keeps the largest cluster.");
    is.source("[Tang2024] 2.3.2, [Xiong2018]");
    is.input("matches", &In::matches, "the pairs to cluster");
    is.input("poses", &In::poses, "the current poses of the segments");
    is.output("matches", &Out::matches, "the pairs of one cluster");
    is.choice("vector", &Params::vector,
              {{"displacement", Vector::displacement, "p - q under the current poses"},
               {"motion", Vector::motion,
                "the displacement, and the rotation between the points' normals"}})
        .doc("the vector that a pair is clustered by");
    is.param("lever", &Params::lever)
        .unit("m")
        .range(0, 100)
        .doc("displacement that weighs as much as a rotation by 1 rad; for 'vector: motion'");
    is.param("pairs_per_cluster", &Params::pairs_per_cluster)
        .range(1, 1e6)
        .doc("there is one cluster for this many pairs, and at least two");
    is.param("max_clusters", &Params::max_clusters).range(2, 1000).doc("number of clusters");
    is.choice("keep", &Params::keep,
              {{"largest", Keep::largest, "the cluster with the most pairs, as in the paper"},
               {"densest", Keep::densest, "the cluster with the most pairs for its spread"}})
        .doc("which cluster is kept");
    is.param("min_spread", &Params::min_spread)
        .unit("m")
        .range(0.001, 100)
        .doc("spread below which clusters count as equally tight; for 'keep: densest'");
    is.param("min_pairs", &Params::min_pairs)
        .range(2, 1e6)
        .doc("fewer pairs than this are kept as they are: too few to cluster");
    is.param("seed", &Params::seed).doc("another draw for each number; 0: by the inputs alone");
  }

  Out run(const In& in, const Params& params, Context& context) const {
    const Matches& matches = *in.matches;
    if (matches.size() < params.min_pairs) {
      if (matches.size() > 0) context.count("edges with too few pairs to group, kept whole", 1);
      return {matches};
    }
    const auto vectors = params.vector == Vector::displacement
                             ? displacements(matches, in.poses.T_i_j)
                             : motions(matches, in.poses.T_i_j, params.lever);
    const auto wanted = static_cast<std::uint32_t>(matches.size()) / params.pairs_per_cluster;
    const auto clusters = kmeans(vectors, std::clamp(wanted, 2u, params.max_clusters),
                                 Random(reseeded(context.seed(), params.seed)));
    const auto kept =
        best_cluster(clusters, vectors, params.keep, params.min_spread, params.min_pairs);
    context.count("pairs dropped", matches.size() - kept.size());
    return {select(matches, kept)};
  }
};

}  // namespace
}  // namespace plumb::prune_kmeans

PLUMB_MODULE(plumb::prune_kmeans::KMeans)
