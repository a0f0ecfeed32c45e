#include "plumb/slam/step.hpp"

#include "metrics.hpp"
#include "plumb/data/document.hpp"
#include "plumb/plugin/module.hpp"

namespace plumb::write_metrics {
namespace {

struct WriteMetrics : WholeStep {
  struct In {
    Several<Metrics> metrics;
  };
  struct Out {
    Document document;
  };
  struct Params {
    std::string name = "metrics.json";
    std::string check() const {
      return name.empty() || name.find('/') != std::string::npos
                 ? "name must be a file name without a folder, not '" + name + "'"
                 : "";
    }
  };

  static void describe(Declaration<WriteMetrics>& is) {
    is.name("write.metrics")
        .version(1)
        .summary("Writes the metrics of all stages, and the status of each edge, as JSON.");
    is.input("metrics", &In::metrics, "any number of metrics; the label is the stage's name");
    is.output("document", &Out::document, "the file");
    is.param("name", &Params::name).doc("name of the file in the output folder");
  }

  Out run(const In& in, const Params& params, Context&) const {
    std::vector<std::pair<std::string, const Metrics*>> stages;
    for (const auto& [label, value] : in.metrics) stages.emplace_back(label, &*value);
    return {{params.name, metrics_json(stages)}};
  }
};

}  // namespace
}  // namespace plumb::write_metrics

PLUMB_MODULE(plumb::write_metrics::WriteMetrics)
