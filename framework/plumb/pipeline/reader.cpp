#include "plumb/pipeline/reader.hpp"

#include "plumb/pipeline/bind/draft.hpp"
#include "plumb/pipeline/check/checks.hpp"
#include "plumb/pipeline/print/resolved.hpp"
#include "plumb/pipeline/yaml/load.hpp"

namespace plumb {

using namespace pipeline;

namespace {

/// `judged`: the text was made of a pipeline that was checked, so that what nothing uses was left
/// so on purpose.
Plan plan_of(Loaded loaded, const Overlay& overlay, bool judged, const Registry& registry,
             Renamer& names, Diagnostics& diagnostics) {
  Draft draft{.registry = registry,
              .diagnostics = diagnostics,
              .names = names,
              .tree = std::move(loaded.tree),
              .referenced = std::move(loaded.referenced),
              .open = overlay.open};
  draft.plan.files = std::move(loaded.files);
  read_settings(draft);
  read_steps(draft);
  read_parameters(draft);
  read_wires(draft);
  read_conditions(draft);
  if (!judged) find_unused(draft);
  if (overlay.untrusted)
    find_foreign_paths(draft);
  else if (overlay.needs_files)
    find_missing_files(draft);
  find_order(draft);
  find_domains(draft);
  diagnostics.raise();

  rewrite(draft);
  draft.plan.renamings = names.noted();
  draft.plan.resolved = resolved_text(draft);
  return std::move(draft.plan);
}

}  // namespace

Plan read_pipeline(const std::filesystem::path& file, const Overlay& overlay,
                   const Registry& registry, const FormerNames& former) {
  Diagnostics diagnostics;
  Renamer names(former, registry, diagnostics);
  auto loaded = load_pipeline(file, overlay, names, diagnostics);
  if (!loaded) diagnostics.raise();
  return plan_of(std::move(*loaded), overlay, false, registry, names, diagnostics);
}

Plan read_resolved(const std::string& text, const std::string& name, const Registry& registry,
                   const FormerNames& former) {
  Diagnostics diagnostics;
  auto tree = parse_yaml(text, name, diagnostics);
  if (!tree) diagnostics.raise();
  Renamer names(former, registry, diagnostics);
  names.read_pipeline(*tree);
  Overlay overlay;
  overlay.needs_files = true;
  return plan_of({std::move(*tree), {name}, {}}, overlay, true, registry, names, diagnostics);
}

}  // namespace plumb
