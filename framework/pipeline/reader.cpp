#include "plumb/pipeline/reader.hpp"

#include "plumb/pipeline/draft.hpp"
#include "plumb/pipeline/overlay.hpp"

namespace plumb {

using namespace pipeline;

Plan read_pipeline(const std::filesystem::path& file, const Overlay& overlay,
                   const Registry& registry) {
  Diagnostics diagnostics;
  std::vector<std::string> files;
  auto tree = load_pipeline(file, overlay, diagnostics, files);
  if (!tree) diagnostics.raise();

  Draft draft{registry, diagnostics, std::move(*tree), overlay.open, {}, {}, {}, {}, {}, false};
  draft.plan.files = std::move(files);
  read_settings(draft);
  read_steps(draft);
  read_parameters(draft);
  read_wires(draft);
  read_conditions(draft);
  find_unused(draft);
  if (overlay.needs_files) find_missing_files(draft);
  find_order(draft);
  find_domains(draft);
  diagnostics.raise();

  draft.plan.resolved = resolved_text(draft);
  return std::move(draft.plan);
}

}  // namespace plumb
