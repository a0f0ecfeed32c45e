#include "../fuzz.hpp"
#include "plumb/pipeline/print/graph.hpp"
#include "plumb/pipeline/print/table.hpp"
#include "plumb/pipeline/reader.hpp"
#include "plumb/pipeline/testing/test_steps.hpp"

using namespace plumb;

/// From YAML to a checked plan, as `plumb check` and `plumb graph` take it.
PLUMB_FUZZ_READER(pipeline) {
  const Plan plan = read_pipeline(fuzz::file_of(bytes, "a.yaml"), {}, test::registry());
  passes_table(plan);
  mermaid_graph(plan);
  dot_graph(plan);
  // Its comments say where each value came from: from the second time on, from itself.
  const auto again = [](const std::string& text) {
    return read_pipeline(fuzz::file_of(text, "b.yaml"), {}, test::registry()).resolved;
  };
  const std::string resolved = again(plan.resolved);
  fuzz::require(again(resolved) == resolved, "a resolved pipeline resolves to itself");
}
