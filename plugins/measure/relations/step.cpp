#include "plumb/slam/step.hpp"

#include "plumb/plugin/module.hpp"
#include "relations.hpp"

namespace plumb::measure_relations {
namespace {

struct MeasureRelations : WholeStep {
  struct In {
    Several<Trajectory> trajectories;
  };
  struct Out {
    Metrics metrics;
  };
  struct Params {
    std::optional<std::filesystem::path> relations;
    double tolerance = 0.3;
  };

  static void describe(Declaration<MeasureRelations>& is) {
    is.name("measure.relations").version(1).source("[Kuemmerle2009]");
    is.summary(
        "Measures the error of trajectories against true relative poses between pairs of times.");
    is.input("trajectories", &In::trajectories,
             "any number of trajectories; numbers are named after the label");
    is.output("metrics", &Out::metrics,
              "for each trajectory the translation and rotation error, absolute and squared, mean "
              "and standard deviation");
    is.param("relations", &Params::relations)
        .doc(
            "file with lines 'from to x y z roll pitch yaw' [s, m, rad]; none: a note, and no "
            "numbers");
    is.param("tolerance", &Params::tolerance)
        .unit("s")
        .range(0, 1000)
        .doc("a time is associated with the nearest frame if that is at most this far away");
  }

  Out run(const In& in, const Params& params, Context& context) const {
    Out out;
    if (!params.relations) {
      out.metrics.notes.push_back(
          "no relations were given, so the trajectories' relative errors are not known");
      return out;
    }
    const RelationsFile file = read_relations(*params.relations);
    if (file.too_short)
      context.count("lines of the relations with fewer than 8 words left out", file.too_short);
    for (const auto& [label, trajectory] : in.trajectories) {
      const RelationErrors errors = relation_errors(file.relations, *trajectory, params.tolerance);
      const std::string whose = label.empty() ? "the trajectory" : "'" + label + "'";
      if (errors.used < file.relations.size()) {
        const std::string sentence = std::to_string(file.relations.size() - errors.used) + " of " +
                                     std::to_string(file.relations.size()) +
                                     " relations have no frame of " + whose +
                                     " within the tolerance and do not count";
        out.metrics.notes.push_back(sentence);
        context.warn(sentence + "; look whether both files are of the same run");
      }
      if (errors.used > 0) add(out.metrics, label.empty() ? "" : label + ".", errors);
    }
    return out;
  }

  static void add(Metrics& metrics, const std::string& of, const RelationErrors& e) {
    metrics.add(of + "translation", e.translation.mean, "m")
        .add(of + "rotation", e.rotation.mean, "rad")
        .add(of + "translation_deviation", e.translation.deviation, "m")
        .add(of + "rotation_deviation", e.rotation.deviation, "rad")
        .add(of + "translation_squared", e.translation_squared.mean, "m^2")
        .add(of + "rotation_squared", e.rotation_squared.mean, "rad^2")
        .add(of + "translation_squared_deviation", e.translation_squared.deviation, "m^2")
        .add(of + "rotation_squared_deviation", e.rotation_squared.deviation, "rad^2")
        .add(of + "relations", static_cast<double>(e.used), "");
  }
};

}  // namespace
}  // namespace plumb::measure_relations

PLUMB_MODULE(plumb::measure_relations::MeasureRelations)
