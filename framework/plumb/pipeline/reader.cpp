#include "plumb/pipeline/reader.hpp"

#include <memory>

#include "plumb/pipeline/plan_of.hpp"
#include "plumb/pipeline/yaml/load.hpp"

namespace plumb {

using namespace pipeline;

namespace {

/// Stage after stage; each gives a value that nobody changes, and takes those of the stages before.
/// `judged`: the text was made of a pipeline that was checked (check_unused).
Plan compiled(Loaded tree, const Overlay& overlay, bool judged, const Registry& registry,
              Renamer& names, Diagnostics& diagnostics) {
  auto loaded = std::make_shared<const Loaded>(std::move(tree));
  const Declared declared = declare(std::move(loaded), overlay.open, registry, names, diagnostics);
  const Bound bound = bind(declared, names, diagnostics);
  check_unused(bound, judged, diagnostics);
  if (overlay.untrusted)
    check_foreign_paths(bound, diagnostics);
  else if (overlay.needs_files)
    check_missing_files(bound, diagnostics);
  const Order order = order_of(bound, diagnostics);
  const Domains domains = domains_of(bound, order, diagnostics);
  diagnostics.raise();
  return plan_of(bound, order, domains, names.noted());
}

}  // namespace

Plan read_pipeline(const std::filesystem::path& file, const Overlay& overlay,
                   const Registry& registry, const FormerNames& former) {
  Diagnostics diagnostics;
  Renamer names(former, registry, diagnostics);
  auto loaded = load_pipeline(file, overlay, names, diagnostics);
  if (!loaded) diagnostics.raise();
  return compiled(std::move(*loaded), overlay, false, registry, names, diagnostics);
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
  return compiled({std::move(*tree), {name}, {}}, overlay, true, registry, names, diagnostics);
}

}  // namespace plumb
